//! Nyquist's count for a plant without polynomials, by enclosures: complete between the points.
//!
//! ```text
//! Z = P - (1/pi) (change of arg(1 + L), w = 0 .. infinity)
//! ```
//!
//! From each frequency to the next 1 + L stays in a disc that does not contain zero, so that its
//! turn is the angle between its ends. Below the first frequency this holds for s^m (1 + L), where
//! m is the number of integrators of the controller; above the last |L| stays below one.

use num_complex::Complex64;
use phea_dynamics::analytic::{Analytic, Disc};
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::portable;
use phea_dynamics::uncertain_plant::responding::RespondingPlant;

use super::Irresolution;
use super::measured::outside_of_stable_region;
use crate::closed_loop::Compensation;

/// Largest number of steps along the axis.
const STEPS_MAXIMUM: usize = 100_000;
/// Step, as a fraction of its frequency, at which a loop that is still not enclosed counts as being
/// on the boundary.
const SHORTEST: f64 = 1e-10;
/// Gain |L| that is never reached beyond the last frequency.
const SMALL_GAIN: f64 = 0.5;
/// Factor above the range of the plant up to which the loop is followed.
const FAR_ABOVE: f64 = 1e4;

/// A plant without polynomials within a continuous loop.
pub(super) struct EnclosedLoop<'a> {
    pub(super) plant: &'a dyn RespondingPlant,
    pub(super) sensor: &'a TransferFunction,
    pub(super) delay_s: f64,
    pub(super) compensation: &'a Compensation,
}

impl EnclosedLoop<'_> {
    /// Number of closed-loop poles in the right half plane.
    pub(super) fn unstable_poles(&self) -> Result<usize, Irresolution> {
        let feedback = self.compensation.feedback();
        let of_plant = self.plant.unstable_poles().ok_or(Irresolution::OpenLoopPoles)?;
        let own = outside_of_stable_region(feedback)? + outside_of_stable_region(self.sensor)? + of_plant;
        let integrators = integrators(feedback) + integrators(self.sensor);
        let (mut from, mut turned) = self.below(integrators)?;
        let [_, top] = self.plant.range_rad_per_s();
        let last = FAR_ABOVE * top;
        let mut here = 1.0 + self.point(from, integrators);
        let mut step = 0.1 * from;
        for _ in 0..STEPS_MAXIMUM {
            if portable::magnitude(here - 1.0) < SMALL_GAIN && self.stays_small(from) {
                turned -= portable::argument(here);
                return counted(own, turned);
            }
            if from > last {
                let gain = portable::magnitude(here - 1.0);
                return Err(Irresolution::HighEnd { frequency_rad_per_s: from, gain });
            }
            let to = from + step;
            let over = self.enclosed([from, to], integrators) + Disc::from(1.0);
            if over.distance() > 0.0 {
                let next = 1.0 + self.point(to, integrators);
                turned += portable::argument(next / here);
                (from, here, step) = (to, next, (1.6 * step).min(to));
            } else if step > SHORTEST * from {
                step /= 2.0;
            } else {
                return Err(Irresolution::NearBoundary { frequency_rad_per_s: from });
            }
        }
        Err(Irresolution::Budget { frequency_rad_per_s: from })
    }

    /// The first frequency, and the turn of 1 + L up to it, passing m integrators on the right: the
    /// turn of s^m (1 + L), less m pi/2.
    fn below(&self, integrators: i32) -> Result<(f64, f64), Irresolution> {
        let [mut first, _] = self.plant.range_rad_per_s();
        for _ in 0..40 {
            let power = |s: Disc| (0..integrators).fold(Disc::from(1.0), |power, _| power * s);
            let whole = |frequencies: [f64; 2]| {
                power(Disc::of_frequencies(frequencies)) + self.without_integrators(frequencies)
            };
            if whole([0.0, first]).distance() > 0.0 {
                let (start, end) = (whole([0.0; 2]).centre(), whole([first; 2]).centre());
                let quarters = f64::from(integrators) * std::f64::consts::FRAC_PI_2;
                return Ok((first, portable::argument(end / start) - quarters));
            }
            first /= 2.0;
        }
        Err(Irresolution::LowEnd { frequency_rad_per_s: first, slope: None })
    }

    /// Open loop L at one frequency.
    fn point(&self, frequency: f64, integrators: i32) -> Complex64 {
        let s = Complex64::new(0.0, frequency);
        let [plant, _] = self.plant.response(frequency);
        let power = (0..integrators).fold(Complex64::ONE, |power, _| power * s);
        plant * self.around(s) / power
    }

    /// A disc that contains L between two frequencies.
    fn enclosed(&self, frequencies: [f64; 2], integrators: i32) -> Disc {
        let s = Disc::of_frequencies(frequencies);
        let power = (0..integrators).fold(Disc::from(1.0), |power, _| power * s);
        self.without_integrators(frequencies) / power
    }

    /// A disc that contains s^m L between two frequencies.
    fn without_integrators(&self, frequencies: [f64; 2]) -> Disc {
        self.plant.enclosure(frequencies) * self.around(Disc::of_frequencies(frequencies))
    }

    /// Function s^m G H e^(-s T_d).
    fn around<A: Analytic>(&self, s: A) -> A {
        let delayed = (-s.scaled(self.delay_s)).exponential();
        factored(self.compensation.feedback(), s) * factored(self.sensor, s) * delayed
    }

    /// True if |L| stays below [`SMALL_GAIN`] from this frequency on.
    ///
    /// ```text
    /// |s - z| <= w (1 + |z|/w),   |s - p| >= w (1 - |p|/w)          both tend to w as w grows
    /// ```
    fn stays_small(&self, frequency: f64) -> bool {
        let Some(plant) = self.plant.roll_off(frequency) else { return false };
        let mut bound = plant;
        let mut power = -3;
        for function in [self.compensation.feedback(), self.sensor] {
            let (zeros, poles) = (function.zeros(), function.poles());
            let part = |root: &Complex64| portable::magnitude(*root) / frequency;
            bound *= function.gain().abs();
            bound *= zeros.iter().map(|zero| 1.0 + part(zero)).product::<f64>();
            bound /= poles.iter().map(|pole| (1.0 - part(pole)).max(0.0)).product::<f64>();
            let more = zeros.len() as i32 - poles.len() as i32;
            bound *= portable::pow(frequency, f64::from(more));
            power += more;
        }
        power <= 0 && bound < SMALL_GAIN
    }
}

fn counted(own: usize, turned: f64) -> Result<usize, Irresolution> {
    let count = own as f64 - turned / std::f64::consts::PI;
    if (count - count.round()).abs() > 1e-6 || count.round() < 0.0 {
        return Err(Irresolution::Count { count });
    }
    Ok(count.round() as usize)
}

fn integrators(function: &TransferFunction) -> i32 {
    function.poles().iter().filter(|pole| pole.norm_sqr() == 0.0).count() as i32
}

/// A factored function without its poles at zero.
fn factored<A: Analytic>(function: &TransferFunction, s: A) -> A {
    let mut poles = function.poles().iter().filter(|pole| pole.norm_sqr() > 0.0);
    let mut value = A::from(function.gain());
    for zero in function.zeros() {
        value = value * (s - A::from(*zero));
        if let Some(pole) = poles.next() {
            value = value / (s - A::from(*pole));
        }
    }
    for pole in poles {
        value = value / (s - A::from(*pole));
    }
    match function.dead_time_s() {
        0.0 => value,
        dead_time_s => value * (-s.scaled(dead_time_s)).exponential(),
    }
}
