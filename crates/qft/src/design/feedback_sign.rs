//! Sign of a controller for negative feedback.

use phea_dynamics::linear::Polynomial;
use phea_dynamics::uncertain_plant::RationalCoefficients;

/// The sign that k needs for feedback to oppose the plant: the sign of lim s^type P(s), reversed by
/// every real pole in the right half plane, which the loop must encircle.
pub(super) fn opposing_sign(command: &RationalCoefficients<f64>) -> f64 {
    let lowest =
        |coefficients: &[f64]| coefficients.iter().rev().copied().find(|one| *one != 0.0).unwrap_or(1.0);
    let at_rest = 1.0_f64.copysign(lowest(&command.numerator) * lowest(&command.denominator));
    let poles = Polynomial::new(command.denominator.clone()).roots().unwrap_or_default();
    let turns = poles.iter().filter(|pole| pole.im == 0.0 && pole.re > 0.0).count();
    if turns % 2 == 0 { at_rest } else { -at_rest }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Integral control of a stable plant needs the sign of its static gain; (s + 0.1)/(s^2 - 2.25)
    /// needs k > 0.
    #[test]
    fn feedback_opposes_the_plant() {
        let sign = |numerator: &[f64], denominator: &[f64]| {
            opposing_sign(&RationalCoefficients {
                numerator: numerator.to_vec(),
                denominator: denominator.to_vec(),
            })
        };
        assert_eq!(sign(&[2.0], &[1.0, 4.0, 3.0]), 1.0);
        assert_eq!(sign(&[-2.0], &[1.0, 0.0]), -1.0);
        assert_eq!(sign(&[-1.0, 1.0], &[1.0, 2.0, 1.0]), 1.0);
        assert_eq!(sign(&[1.0, 0.1], &[1.0, 0.0, -2.25]), 1.0);
    }
}
