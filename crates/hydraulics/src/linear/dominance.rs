use num_complex::Complex64;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::order::sort_by_number;
use phea_dynamics::portable;

/// Contribution of one mode (a real pole or a conjugate pair) to the step response.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModeContribution {
    /// Pole, for a pair the one with positive imaginary part, rad/s.
    pub pole: Complex64,
    /// Greatest amplitude of this mode in the step response over the final value: |residue/pole|,
    /// twice that for a pair.
    pub step_fraction: f64,
    /// Ratio of the decay rate of this mode to that of the slowest.
    pub decay_ratio: f64,
    /// Reason why a number does not exist and is NaN.
    pub absence: Option<ContributionAbsence>,
}

/// Reason why a mode has no fraction of the step response.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ContributionAbsence {
    /// Pole at the origin or to its right: neither fraction nor decay ratio exists.
    #[error("a mode does not decay, so that the step response has no final value to share")]
    NoFinalValue,
    /// Static gain of zero.
    #[error("the step response ends at zero")]
    ZeroFinalValue,
    /// Pole that coincides with another: no separate fraction.
    #[error(
        "the pole coincides with another: together they decay as a polynomial in time times one exponential"
    )]
    CoincidentPole,
}

/// Dominance of each mode of a stable system as numbers, slowest mode first.
///
/// ```text
/// y(t)/y(inf) = 1 + sum_i (r_i/p_i)/G(0) e^(p_i t),      r_i = residue of G at its simple pole p_i
/// step_fraction_i = |r_i/(p_i G(0))|  (twice for a pair),      decay_ratio_i = Re p_i / max_k Re p_k
/// ```
///
/// A mode is dominant when its fraction is near one, those of the others are near zero and their
/// decay ratios are large. Fractions of poles that coincide with another (to 1e-6), or of a system
/// with a pole not left of the axis, do not exist and are NaN; `absence` says why.
///
/// # Example
/// Over 1/((s + 1)(s + 100)) the slow pole carries 100/99 of the step and the fast one 1/99.
/// ```
/// use num_complex::Complex64;
/// use phea_dynamics::linear::TransferFunction;
/// use phea_hydraulics::linear::dominance;
/// let pole = |re| Complex64::new(re, 0.0);
/// let modes = dominance(&TransferFunction::from_factors(1.0, vec![], vec![pole(-100.0), pole(-1.0)])?);
/// assert!((modes[0].step_fraction - 100.0 / 99.0).abs() < 1e-14 && modes[0].pole.re == -1.0);
/// assert!((modes[1].step_fraction - 1.0 / 99.0).abs() < 1e-14 && modes[1].decay_ratio == 100.0);
/// # Ok::<(), phea_dynamics::linear::LinearError>(())
/// ```
pub fn dominance(system: &TransferFunction) -> Vec<ModeContribution> {
    let static_gain = system.dc_gain();
    let slowest = system.poles().iter().map(|pole| pole.re).fold(f64::NEG_INFINITY, f64::max);
    let mut modes: Vec<ModeContribution> = system
        .poles()
        .iter()
        .enumerate()
        .filter(|(_, pole)| pole.im >= 0.0)
        .map(|(index, &pole)| {
            let count = if pole.im > 0.0 { 2.0 } else { 1.0 };
            let fraction =
                count * portable::magnitude(residue(system, index, pole) / pole) / static_gain.abs();
            let absence = match () {
                () if slowest >= 0.0 => Some(ContributionAbsence::NoFinalValue),
                () if static_gain == 0.0 => Some(ContributionAbsence::ZeroFinalValue),
                () if coincides(system, index, pole) => Some(ContributionAbsence::CoincidentPole),
                () => None,
            };
            ModeContribution {
                pole,
                step_fraction: if absence.is_none() { fraction } else { f64::NAN },
                decay_ratio: if slowest < 0.0 { pole.re / slowest } else { f64::NAN },
                absence,
            }
        })
        .collect();
    sort_by_number(&mut modes, |mode| -mode.pole.re);
    modes
}

/// Relative distance within which two poles count as one: numerical roots of a double pole are that
/// far apart.
const COINCIDENCE: f64 = 1e-6;

fn coincides(system: &TransferFunction, index: usize, pole: Complex64) -> bool {
    let mut others = system.poles().iter().enumerate().filter(|(other, _)| *other != index);
    others.any(|(_, other)| portable::magnitude(pole - other) <= COINCIDENCE * portable::magnitude(pole))
}

/// Residue at the simple pole with this index: gain prod(p - z)/prod(p - other poles).
fn residue(system: &TransferFunction, index: usize, pole: Complex64) -> Complex64 {
    let numerator =
        system.zeros().iter().fold(Complex64::new(system.gain(), 0.0), |r, zero| r * (pole - zero));
    let others = system.poles().iter().enumerate().filter(|(other, _)| *other != index);
    others.fold(numerator, |r, (_, other)| r / (pole - other))
}
