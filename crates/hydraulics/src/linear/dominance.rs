use num_complex::Complex64;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::portable;

/// What one mode (a real pole or a conjugate pair) contributes to the step response.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModeShare {
    /// The pole, of a pair the one with positive imaginary part, in rad/s.
    pub pole: Complex64,
    /// Greatest amplitude of this mode in the step response over the final value: |residue/pole|, twice that for a pair.
    pub step_share: f64,
    /// Decay rate of this mode over that of the slowest: how many times faster it is gone.
    pub decay_ratio: f64,
}

/// Dominance of each mode of a stable system as numbers, slowest mode first.
///
/// ```text
/// y(t)/y(inf) = 1 + sum_i (r_i/p_i)/G(0) e^(p_i t),      r_i = residue of G at its simple pole p_i
/// step_share_i = |r_i/(p_i G(0))|  (twice for a pair),      decay_ratio_i = Re p_i / max_k Re p_k
/// ```
///
/// A mode is dominant when its share is near one and the others' are near zero and their decay ratios are large. Shares of
/// poles that coincide with another, or of a system with a pole at zero, do not exist and are not a number.
///
/// # Example
/// Over 1/((s + 1)(s + 100)) the slow pole carries 100/99 of the step and the fast one 1/99.
/// ```
/// use num_complex::Complex64;
/// use phea_dynamics::linear::TransferFunction;
/// use phea_hydraulics::linear::dominance;
/// let pole = |re| Complex64::new(re, 0.0);
/// let modes = dominance(&TransferFunction::from_factors(1.0, vec![], vec![pole(-100.0), pole(-1.0)])?);
/// assert!((modes[0].step_share - 100.0 / 99.0).abs() < 1e-14 && modes[0].pole.re == -1.0);
/// assert!((modes[1].step_share - 1.0 / 99.0).abs() < 1e-14 && modes[1].decay_ratio == 100.0);
/// # Ok::<(), phea_dynamics::linear::LinearError>(())
/// ```
pub fn dominance(system: &TransferFunction) -> Vec<ModeShare> {
    let static_gain = system.dc_gain();
    let slowest = system.poles().iter().map(|pole| pole.re).fold(f64::NEG_INFINITY, f64::max);
    let mut modes: Vec<ModeShare> = system
        .poles()
        .iter()
        .enumerate()
        .filter(|(_, pole)| pole.im >= 0.0)
        .map(|(index, &pole)| {
            let count = if pole.im > 0.0 { 2.0 } else { 1.0 };
            let residue = residue(system, index, pole);
            ModeShare {
                pole,
                step_share: count * portable::magnitude(residue / pole) / static_gain.abs(),
                decay_ratio: pole.re / slowest,
            }
        })
        .collect();
    modes.sort_by(|a, b| b.pole.re.total_cmp(&a.pole.re));
    modes
}

/// Residue at the simple pole with this index: gain prod(p - z)/prod(p - other poles).
fn residue(system: &TransferFunction, index: usize, pole: Complex64) -> Complex64 {
    let numerator =
        system.zeros().iter().fold(Complex64::new(system.gain(), 0.0), |r, zero| r * (pole - zero));
    let others = system.poles().iter().enumerate().filter(|(other, _)| *other != index);
    others.fold(numerator, |r, (_, other)| r / (pole - other))
}
