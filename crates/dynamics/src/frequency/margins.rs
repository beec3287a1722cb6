//! Gain, phase, modulus and delay margins of a loop.

use std::f64::consts::PI;

use num_complex::Complex64;

use super::crossings::SlopedFunction;
use super::decibels;
use super::grid::{rotation_limit, search_grid};
use crate::linear::{TimeDomain, TransferFunction};
use crate::order::sort_by_number;
use crate::portable::{ln, magnitude};

/// A crossing of the negative real axis: the loop passes through -1 when its gain is multiplied by
/// `factor`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GainMargin {
    /// Phase crossover frequency in rad/s; zero or infinity if the response ends on the negative
    /// axis.
    pub frequency_rad_per_s: f64,
    /// Factor 1/|L|. Above one, the gain may grow to this multiple; below one, it may fall to it.
    pub factor: f64,
}

impl GainMargin {
    /// The factor in dB.
    pub fn db(&self) -> f64 {
        decibels(self.factor)
    }
}

/// A crossing of the unit circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhaseMargin {
    /// Gain crossover frequency in rad/s.
    pub frequency_rad_per_s: f64,
    /// Angle from -1 to L in degrees, in (-180, 180]: lag (if positive) or lead (if negative) that
    /// brings L to -1.
    pub phase_deg: f64,
    /// Dead time in s that brings this crossing to -1: the angle, taken as a lag in [0, 360), over
    /// the frequency.
    pub delay_s: f64,
}

/// Closest approach of the response to -1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModulusMargin {
    /// Frequency of the closest approach in rad/s; may be zero or infinity.
    pub frequency_rad_per_s: f64,
    /// Distance min |1 + L|, the inverse of the largest sensitivity.
    pub distance: f64,
}

/// All margins of a loop L, crossings in order of frequency.
///
/// The numbers are distances of the response from -1; they are margins of stability only for a loop
/// that is stable when closed.
#[derive(Clone, Debug, PartialEq)]
pub struct Margins {
    /// Crossings of the negative real axis.
    pub gain_margins: Vec<GainMargin>,
    /// Crossings of the unit circle.
    pub phase_margins: Vec<PhaseMargin>,
    /// Closest approach to -1.
    pub modulus_margin: ModulusMargin,
}

impl Margins {
    /// Crossing that limits an increase of gain (smallest factor of at least one); `None` if any
    /// increase is allowed.
    pub fn gain_increase(&self) -> Option<&GainMargin> {
        let above = self.gain_margins.iter().filter(|margin| margin.factor >= 1.0);
        above.min_by(|a, b| a.factor.total_cmp(&b.factor))
    }

    /// Crossing that limits a decrease of gain (largest factor below one); `None` if any decrease
    /// is allowed.
    pub fn gain_decrease(&self) -> Option<&GainMargin> {
        let below = self.gain_margins.iter().filter(|margin| margin.factor < 1.0);
        below.max_by(|a, b| a.factor.total_cmp(&b.factor))
    }

    /// Factor by which the gain may grow; infinite without limit.
    pub fn gain_increase_factor(&self) -> f64 {
        self.gain_increase().map_or(f64::INFINITY, |margin| margin.factor)
    }

    /// Factor to which the gain may fall; zero without limit.
    pub fn gain_decrease_factor(&self) -> f64 {
        self.gain_decrease().map_or(0.0, |margin| margin.factor)
    }

    /// Crossing of the unit circle nearest to -1; `None` if |L| is never one.
    pub fn critical_phase(&self) -> Option<&PhaseMargin> {
        self.phase_margins.iter().min_by(|a, b| a.phase_deg.abs().total_cmp(&b.phase_deg.abs()))
    }

    /// Smallest angle to -1 in degrees; infinite if |L| is never one.
    pub fn phase_margin_deg(&self) -> f64 {
        self.critical_phase().map_or(f64::INFINITY, |margin| margin.phase_deg)
    }

    /// Crossing that the least dead time brings to -1.
    pub fn critical_delay(&self) -> Option<&PhaseMargin> {
        self.phase_margins.iter().min_by(|a, b| a.delay_s.total_cmp(&b.delay_s))
    }

    /// Least dead time in s that brings the loop to -1; infinite if none does.
    pub fn delay_margin_s(&self) -> f64 {
        self.critical_delay().map_or(f64::INFINITY, |margin| margin.delay_s)
    }
}

/// Margins of the loop L, closed by -1 (characteristic equation 1 + L = 0).
///
/// ```text
/// gain:     arg L = -180 deg   ->  1/|L|
/// phase:    |L| = 1            ->  180 deg + arg L,  delay margin = that / frequency
/// modulus:  min over frequency of |1 + L|
/// ```
///
/// Crossings are bracketed on a grid that is dense around every zero and pole, and refined to the
/// last bits on the factors. A response that runs along the negative axis (a double integrator) has
/// no crossing there; its phase margin is zero. With dead time there are infinitely many crossings;
/// the first thousand turns are listed.
///
/// # Example
/// ```
/// use phea_dynamics::frequency::margins;
/// use phea_dynamics::linear::{Polynomial, TransferFunction};
/// # fn main() -> Result<(), phea_dynamics::linear::LinearError> {
/// let open = TransferFunction::from_polynomials(
///     &Polynomial::new(vec![1.0]),
///     &Polynomial::new(vec![1.0, 0.0]),
/// )?;
/// let integrator = margins(&open); // 1/s: crosses at 1 rad/s with 90 degrees left
/// assert_eq!(integrator.phase_margin_deg(), 90.0);
/// assert_eq!(integrator.delay_margin_s(), std::f64::consts::FRAC_PI_2);
/// assert_eq!(integrator.gain_increase_factor(), f64::INFINITY);
/// # Ok(())
/// # }
/// ```
pub fn margins(open_loop: &TransferFunction) -> Margins {
    let grid = search_grid(open_loop);
    let limit = rotation_limit(open_loop);
    let listed: Vec<f64> = grid.iter().copied().filter(|w| *w <= limit).collect();
    Margins {
        gain_margins: gain_margins(open_loop, &listed),
        phase_margins: phase_margins(open_loop, &grid),
        modulus_margin: modulus_margin(open_loop, &grid),
    }
}

/// d ln L / dw at a frequency: the real part is the slope of ln |L|, the imaginary part the slope
/// of the phase.
fn logarithmic_slope(open_loop: &TransferFunction, frequency: f64) -> Complex64 {
    let point = open_loop.boundary_point(frequency);
    let speed = match open_loop.domain() {
        TimeDomain::Continuous => Complex64::new(0.0, 1.0),
        TimeDomain::Discrete { sample_time_s } => Complex64::new(0.0, sample_time_s) * point,
    };
    let sum = |roots: &[Complex64]| roots.iter().map(|root| (point - root).inv()).sum::<Complex64>();
    let rational = speed * (sum(open_loop.zeros()) - sum(open_loop.poles()));
    rational - Complex64::new(0.0, open_loop.dead_time_s())
}

fn gain_margins(open_loop: &TransferFunction, grid: &[f64]) -> Vec<GainMargin> {
    let phases: Vec<f64> = grid.iter().map(|&w| open_loop.phase_rad(w)).collect();
    let mut found = Vec::new();
    for (cell, ends) in grid.windows(2).zip(phases.windows(2)) {
        // levels -pi + 2 pi k within the cell's phases, widened for an extremum between the points
        let (lowest, highest) = (ends[0].min(ends[1]) - 0.5, ends[0].max(ends[1]) + 0.5);
        let mut level = -PI + 2.0 * PI * ((lowest + PI) / (2.0 * PI)).ceil();
        while level <= highest {
            // a response that runs along the negative axis does not cross it
            if ends.iter().any(|phase| (phase - level).abs() > 1e-12) {
                let curve = SlopedFunction {
                    value: |w: f64| open_loop.phase_rad(w) - level,
                    slope: |w: f64| logarithmic_slope(open_loop, w).im,
                };
                found.extend(curve.zeros(cell));
            }
            level += 2.0 * PI;
        }
    }
    // a jump of the phase at an undamped root is not a crossing
    found.retain(|&w| {
        let value = open_loop.at_frequency(w);
        value.re < 0.0 && value.im.abs() <= 1e-6 * value.re.abs()
    });
    let mut margins: Vec<GainMargin> = found.into_iter().map(|w| gain_margin(open_loop, w)).collect();
    margins.extend(gain_margins_at_the_ends(open_loop));
    sort_by_number(&mut margins, |margin| margin.frequency_rad_per_s);
    margins.dedup();
    margins
}

fn gain_margin(open_loop: &TransferFunction, frequency_rad_per_s: f64) -> GainMargin {
    GainMargin { frequency_rad_per_s, factor: 1.0 / magnitude(open_loop.at_frequency(frequency_rad_per_s)) }
}

/// Gain margins where the response starts or ends on the negative real axis with finite gain.
fn gain_margins_at_the_ends(open_loop: &TransferFunction) -> Vec<GainMargin> {
    let start = (0.0, open_loop.dc_gain());
    let end = match open_loop.domain() {
        TimeDomain::Continuous if open_loop.zeros().len() == open_loop.poles().len() => {
            // dead time turns the end of the response through every angle
            let value = open_loop.gain();
            (f64::INFINITY, if open_loop.dead_time_s() > 0.0 { -value.abs() } else { value })
        }
        TimeDomain::Continuous => (f64::INFINITY, 0.0),
        TimeDomain::Discrete { sample_time_s } => {
            let samples = open_loop.dead_time_s() / sample_time_s;
            let sign = if (samples - 2.0 * (samples / 2.0).round()).abs() > 0.5 { -1.0 } else { 1.0 };
            (PI / sample_time_s, sign * open_loop.evaluate_rational(Complex64::new(-1.0, 0.0)).re)
        }
    };
    let negative = [start, end].into_iter().filter(|(_, value)| *value < 0.0 && value.is_finite());
    negative
        .map(|(frequency_rad_per_s, value)| GainMargin { frequency_rad_per_s, factor: -1.0 / value })
        .collect()
}

fn phase_margins(open_loop: &TransferFunction, grid: &[f64]) -> Vec<PhaseMargin> {
    let curve = SlopedFunction {
        value: |w: f64| ln(magnitude(open_loop.at_frequency(w))),
        slope: |w: f64| logarithmic_slope(open_loop, w).re,
    };
    let all_pass = grid.iter().all(|&w| (curve.value)(w).abs() <= 1e-12);
    let crossings = if all_pass { Vec::new() } else { curve.zeros(grid) };
    crossings.into_iter().map(|w| phase_margin(open_loop, w)).collect()
}

fn phase_margin(open_loop: &TransferFunction, frequency_rad_per_s: f64) -> PhaseMargin {
    let turn = 2.0 * PI;
    let angle = open_loop.phase_rad(frequency_rad_per_s) + PI;
    let lag = angle - turn * (angle / turn).floor();
    let lag = if turn - lag < 1e-12 * (1.0 + angle.abs()) { 0.0 } else { lag };
    let signed = if lag > PI { lag - turn } else { lag };
    PhaseMargin { frequency_rad_per_s, phase_deg: signed.to_degrees(), delay_s: lag / frequency_rad_per_s }
}

fn modulus_margin(open_loop: &TransferFunction, grid: &[f64]) -> ModulusMargin {
    let one = Complex64::new(1.0, 0.0);
    let distance = |w: f64| magnitude(one + open_loop.at_frequency(w));
    let curve = SlopedFunction {
        value: distance,
        slope: |w: f64| {
            let value = open_loop.at_frequency(w);
            ((one + value).conj() * value * logarithmic_slope(open_loop, w)).re
        },
    };
    let mut candidates: Vec<(f64, f64)> =
        curve.minima(grid).into_iter().chain(grid.iter().copied()).map(|w| (w, distance(w))).collect();
    candidates.push((0.0, (1.0 + open_loop.dc_gain()).abs()));
    if open_loop.domain() == TimeDomain::Continuous {
        let end = open_loop.evaluate_rational(Complex64::new(f64::INFINITY, 0.0)).re;
        let nearest = if open_loop.dead_time_s() > 0.0 { (1.0 - end.abs()).abs() } else { (1.0 + end).abs() };
        candidates.push((f64::INFINITY, nearest));
    }
    let finite = candidates.into_iter().filter(|(_, distance)| !distance.is_nan());
    let nearest = finite.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((f64::NAN, f64::NAN));
    ModulusMargin { frequency_rad_per_s: nearest.0, distance: nearest.1 }
}
