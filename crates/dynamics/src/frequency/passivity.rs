//! Passivity (positive realness) of a driving-point impedance.

use num_complex::Complex64;

use super::grid::logarithmic_grid;
use crate::linear::even_part::EvenPart;
use crate::linear::{LinearError, LinearOperation, TimeDomain, TransferFunction};
use crate::portable::magnitude;

/// Frequency band in rad/s in which Re Z(jw) < 0; the upper end may be infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// Lower end, rad/s.
    pub from_rad_per_s: f64,
    /// Upper end, rad/s.
    pub to_rad_per_s: f64,
    /// Frequency in rad/s at which the phase of Z most exceeds 90 degrees.
    pub worst_frequency_rad_per_s: f64,
    /// Impedance Z(jw) at that frequency.
    pub worst_impedance: Complex64,
}

/// A pole on the imaginary axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImaginaryPole {
    /// Frequency of the pole in rad/s: zero at the origin, infinity for a pole there (an impedance
    /// that grows like s).
    pub frequency_rad_per_s: f64,
    /// Number of poles that coincide there.
    pub multiplicity: usize,
    /// Residue of a simple pole (at infinity: the factor of s); passive when real and positive.
    pub residue: Option<Complex64>,
    /// True if the pole is simple with a positive real residue.
    pub passive: bool,
}

/// Numbers of the three conditions for the passivity of an impedance.
#[derive(Clone, Debug, PartialEq)]
pub struct PassivityReport {
    /// True if all three conditions hold.
    pub passive: bool,
    /// Poles that violate condition 1.
    pub right_half_plane_poles: Vec<Complex64>,
    /// Poles of condition 2, on the imaginary axis (for each conjugate pair, the one above).
    pub imaginary_poles: Vec<ImaginaryPole>,
    /// Bands that violate condition 3, in which Re Z(jw) < 0.
    pub bands: Vec<Band>,
}

/// Ratio of real part to magnitude below which a pole counts as on the imaginary axis.
const ON_AXIS: f64 = 1e-12;

/// Tests a driving-point impedance Z(s) for passivity (Colgate 1988; Hogan and Buerger 2005; thesis
/// section 2.2).
///
/// ```text
/// 1. no poles in the right half plane
/// 2. poles on the imaginary axis are simple, with positive real residues (0 and infinity included)
/// 3. Re Z(jw) >= 0 at every frequency
/// ```
///
/// Condition 3 is decided on N(jw) conj D(jw), an even polynomial in w formed in twice the working
/// precision: the bands end at its sign changes. A polynomial that vanishes to rounding, as for a
/// lossless network, counts as zero; so does a band in which Re Z nowhere falls below -1e-12 |Z|,
/// since the factors themselves are rounded.
///
/// # Errors
/// [`LinearError::WrongDomain`] for a sampled impedance, [`LinearError::NotRational`] for one with
/// dead time.
///
/// # Example
/// ```
/// use phea_dynamics::frequency::passivity;
/// use phea_dynamics::linear::{Polynomial, TransferFunction};
/// # fn main() -> Result<(), phea_dynamics::linear::LinearError> {
/// let impedance = |n: &[f64], d: &[f64]| {
///     TransferFunction::from_polynomials(&Polynomial::new(n.to_vec()), &Polynomial::new(d.to_vec()))
/// };
/// // a mass, a damper and a spring in parallel: Z = (2 s^2 + 3 s + 5)/s
/// assert!(passivity(&impedance(&[2.0, 3.0, 5.0], &[1.0, 0.0])?)?.passive);
/// // (1 - s + s^2)/(s + 1)^2: Re Z has the sign of w^4 - 4 w^2 + 1
/// let report = passivity(&impedance(&[1.0, -1.0, 1.0], &[1.0, 2.0, 1.0])?)?;
/// assert_eq!(report.bands.len(), 1);
/// assert!((report.bands[0].to_rad_per_s - (2.0_f64 + 3.0_f64.sqrt()).sqrt()).abs() < 1e-14);
/// # Ok(())
/// # }
/// ```
pub fn passivity(impedance: &TransferFunction) -> Result<PassivityReport, LinearError> {
    if impedance.domain() != TimeDomain::Continuous {
        return Err(LinearError::WrongDomain { operation: LinearOperation::Passivity, needed: "continuous" });
    }
    if impedance.dead_time_s() != 0.0 {
        return Err(LinearError::NotRational { operation: LinearOperation::Passivity });
    }
    let on_axis = |pole: &Complex64| pole.re.abs() <= ON_AXIS * magnitude(*pole);
    let right_half_plane_poles: Vec<Complex64> =
        impedance.poles().iter().copied().filter(|pole| pole.re > 0.0 && !on_axis(pole)).collect();
    let mut imaginary_poles = poles_on_the_axis(impedance, on_axis);
    imaginary_poles.extend(pole_at_infinity(impedance));
    let bands = bands_of_negative_real_part(impedance)?;
    let passive = right_half_plane_poles.is_empty()
        && imaginary_poles.iter().all(|pole| pole.passive)
        && bands.is_empty();
    Ok(PassivityReport { passive, right_half_plane_poles, imaginary_poles, bands })
}

fn poles_on_the_axis(
    impedance: &TransferFunction,
    on_axis: impl Fn(&Complex64) -> bool,
) -> Vec<ImaginaryPole> {
    let mut open: Vec<Complex64> =
        impedance.poles().iter().copied().filter(|pole| pole.im >= 0.0 && on_axis(pole)).collect();
    let mut result = Vec::new();
    while let Some(&pole) = open.first() {
        let same = |other: &Complex64| magnitude(other - pole) <= 1e-9 * magnitude(pole);
        let multiplicity = open.iter().filter(|other| same(other)).count();
        open.retain(|other| !same(other));
        let residue = (multiplicity == 1).then(|| residue_at(impedance, pole));
        result.push(ImaginaryPole {
            frequency_rad_per_s: pole.im,
            multiplicity,
            residue,
            passive: residue.is_some_and(is_positive_real),
        });
    }
    result
}

/// True if the number is real to rounding, and positive.
fn is_positive_real(residue: Complex64) -> bool {
    residue.re > 0.0 && residue.im.abs() <= 1e-9 * residue.re
}

/// Residue (s - p) Z(s) at a simple pole p.
fn residue_at(impedance: &TransferFunction, pole: Complex64) -> Complex64 {
    let mut others = impedance.poles().iter().filter(|other| **other != pole);
    let mut value = Complex64::new(impedance.gain(), 0.0);
    for zero in impedance.zeros() {
        value *= pole - zero;
        if let Some(other) = others.next() {
            value /= pole - other;
        }
    }
    others.for_each(|other| value /= pole - other);
    value
}

fn pole_at_infinity(impedance: &TransferFunction) -> Option<ImaginaryPole> {
    let multiplicity = impedance.zeros().len().checked_sub(impedance.poles().len()).filter(|&m| m > 0)?;
    let residue = (multiplicity == 1).then(|| Complex64::new(impedance.gain(), 0.0));
    Some(ImaginaryPole {
        frequency_rad_per_s: f64::INFINITY,
        multiplicity,
        residue,
        passive: residue.is_some_and(is_positive_real),
    })
}

/// Bands in which the even polynomial Re (N conj D) is negative.
fn bands_of_negative_real_part(impedance: &TransferFunction) -> Result<Vec<Band>, LinearError> {
    let real_part = EvenPart::of_product(impedance.gain(), impedance.zeros(), impedance.poles());
    let mut bands: Vec<(f64, f64)> = Vec::new();
    let mut ends = real_part.candidate_frequencies()?;
    ends.push(f64::INFINITY);
    let mut from = 0.0;
    let mut was_negative = false;
    for to in ends {
        if to <= from {
            continue;
        }
        let inside = if to.is_infinite() { 2.0 * from + 1.0 } else { from + 0.5 * (to - from) };
        let negative = real_part.sign_at(inside) < 0;
        match bands.last_mut() {
            Some(last) if negative && was_negative => last.1 = to,
            _ if negative => bands.push((from, to)),
            _ => {}
        }
        was_negative = negative;
        from = to;
    }
    let sharpened = bands
        .into_iter()
        .map(|(from, to)| band(impedance, real_part.sign_change_near(from), real_part.sign_change_near(to)));
    Ok(sharpened.filter(|band| band.worst_impedance.re < -1e-12 * magnitude(band.worst_impedance)).collect())
}

/// Band with the frequency at which Re Z/|Z| is lowest, searched on successively finer grids.
fn band(impedance: &TransferFunction, from_rad_per_s: f64, to_rad_per_s: f64) -> Band {
    let cosine = |frequency: f64| {
        let value = impedance.at_frequency(frequency);
        value.re / magnitude(value)
    };
    let corners = || impedance.zeros().iter().chain(impedance.poles()).map(|root| magnitude(*root));
    let lowest = corners().filter(|size| *size > 0.0).fold(f64::INFINITY, f64::min).min(1e6);
    let highest = corners().fold(lowest, f64::max);
    // open ends: a few decades beyond the band's other end and all corners
    let low = if from_rad_per_s > 0.0 { from_rad_per_s } else { 1e-4 * lowest.min(to_rad_per_s) };
    let high = if to_rad_per_s.is_finite() { to_rad_per_s } else { 1e4 * highest.max(from_rad_per_s) };
    let (mut left, mut right, mut worst) = (low, high, low.sqrt() * high.sqrt());
    for _ in 0..8 {
        let grid = logarithmic_grid(left, right, 201).unwrap_or_default();
        let best = grid.iter().enumerate().min_by(|a, b| cosine(*a.1).total_cmp(&cosine(*b.1)));
        let Some((index, &frequency)) = best else { break };
        worst = frequency;
        left = grid[index.saturating_sub(1)];
        right = grid[(index + 1).min(grid.len() - 1)];
    }
    Band {
        from_rad_per_s,
        to_rad_per_s,
        worst_frequency_rad_per_s: worst,
        worst_impedance: impedance.at_frequency(worst),
    }
}
