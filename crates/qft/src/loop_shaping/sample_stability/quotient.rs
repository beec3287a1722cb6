//! Parts of a loop as quotients of polynomials in s, or in w.
//!
//! ```text
//! w = (z - 1)/(z + 1):   z - p = ((2 + r) w - r)/(1 - w)  with r = p - 1,      z = (1 + w)/(1 - w)
//! ```
//!
//! The factors of 1 - w are multiplied out. A slow pole is near w = s T/2, so that no digits are
//! lost.

use num_complex::Complex64;
use phea_dynamics::linear::{Polynomial, TimeDomain, TransferFunction};

use super::rounded_polynomial::RoundedPolynomial;
use crate::closed_loop::Member;

/// Samples of delay that may become factors of w.
const DELAY_MAXIMUM: f64 = 24.0;

/// Numerator over denominator, without cancellation; both of equal degree in w.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct BilinearQuotient {
    numerator: RoundedPolynomial,
    denominator: RoundedPolynomial,
}

impl BilinearQuotient {
    /// Quotient P H of a member; `None` for a measurement, and for a dead time that leaves no
    /// polynomials.
    pub(super) fn of_member(member: &Member) -> Option<BilinearQuotient> {
        match member {
            Member::Continuous { plant, sensor, .. } if plant.dead_time_s == 0.0 => {
                let sensor = BilinearQuotient::of_function(sensor)?;
                let polynomial = |coefficients: &[f64]| {
                    RoundedPolynomial::exact(Polynomial::new(coefficients.to_vec()).coefficients())
                };
                Some(BilinearQuotient {
                    numerator: polynomial(&plant.command.numerator).times(&sensor.numerator),
                    denominator: polynomial(&plant.command.denominator).times(&sensor.denominator),
                })
            }
            Member::Sampled { with_sensor, .. } => BilinearQuotient::of_function(with_sensor),
            Member::Continuous { .. } | Member::Responding { .. } | Member::Measured { .. } => None,
        }
    }

    /// Quotient P H of a continuous member with dead time T, which is replaced by its third-order
    /// Padé approximation; `None` for other members.
    ///
    /// ```text
    /// e^(-sT) ~ p(-sT)/p(sT),      p(u) = u^3/120 + u^2/10 + u/2 + 1
    /// ```
    pub(super) fn of_delayed_member(member: &Member) -> Option<BilinearQuotient> {
        let Member::Continuous { plant, sensor, fed_forward } = member else { return None };
        let own_s = plant.dead_time_s + sensor.dead_time_s();
        let mut plant = plant.clone();
        plant.dead_time_s = 0.0;
        let sensor = sensor.clone().with_dead_time(0.0).ok()?;
        let fed_forward = fed_forward.clone();
        let rational = BilinearQuotient::of_member(&Member::Continuous { plant, sensor, fed_forward })?;
        let delay = |time_s: f64| {
            let [one, square, cube] = [time_s, time_s * time_s, time_s * time_s * time_s];
            RoundedPolynomial::exact(&[cube / 120.0, square / 10.0, one / 2.0, 1.0])
        };
        Some(BilinearQuotient {
            numerator: rational.numerator.times(&delay(-own_s)),
            denominator: rational.denominator.times(&delay(own_s)),
        })
    }

    /// A transfer function in s or z; `None` for a dead time that leaves no polynomials, and for a
    /// non-causal one in z.
    pub(super) fn of_function(function: &TransferFunction) -> Option<BilinearQuotient> {
        let TimeDomain::Discrete { sample_time_s } = function.domain() else {
            let once = |polynomial: &Polynomial| {
                RoundedPolynomial::rounded(polynomial.coefficients(), polynomial.coefficients(), 1.0)
            };
            let quotient = BilinearQuotient {
                numerator: once(&function.numerator()),
                denominator: once(&function.denominator()),
            };
            return (function.dead_time_s() == 0.0).then_some(quotient);
        };
        let samples = (function.dead_time_s() / sample_time_s).round();
        let lead = function.poles().len().checked_sub(function.zeros().len())?;
        if samples > DELAY_MAXIMUM {
            return None;
        }
        let samples = samples as usize;
        let numerator = in_w(function.gain(), function.zeros());
        let denominator = in_w(1.0, function.poles());
        Some(BilinearQuotient {
            numerator: raised(numerator, &[-1.0, 1.0], lead + samples),
            denominator: raised(denominator, &[1.0, 1.0], samples),
        })
    }

    /// The characteristic polynomial of a loop with both quotients.
    pub(super) fn closed(&self, other: &BilinearQuotient) -> RoundedPolynomial {
        RoundedPolynomial::sum_of_products(&[
            (&self.denominator, &other.denominator),
            (&self.numerator, &other.numerator),
        ])
    }
}

/// The polynomial times this power of this factor.
fn raised(polynomial: RoundedPolynomial, factor: &[f64], count: usize) -> RoundedPolynomial {
    let factor = RoundedPolynomial::exact(factor);
    (0..count).fold(polynomial, |product, _| product.times(&factor))
}

/// Polynomial gain (z - z_1) (z - z_2) ... without its factors of 1 - w.
fn in_w(gain: f64, roots: &[Complex64]) -> RoundedPolynomial {
    let upper = roots.iter().filter(|root| root.im >= 0.0);
    upper.fold(RoundedPolynomial::exact(&[gain]), |product, root| product.times(&factor_in_w(*root)))
}

/// Factor (2 + r) w - r of a real root, and for a complex root its product with that of the
/// conjugate.
fn factor_in_w(root: Complex64) -> RoundedPolynomial {
    let (re, im) = (root.re - 1.0, root.im);
    if im == 0.0 {
        return RoundedPolynomial::rounded(&[2.0 + re, -re], &[2.0 + re, re], 1.0);
    }
    let square = re * re + im * im;
    let highest = (2.0 + re) * (2.0 + re) + im * im;
    let values = [highest, -2.0 * (2.0 * re + square), square];
    RoundedPolynomial::rounded(&values, &[highest, 4.0 * re.abs() + 2.0 * square, square], 4.0)
}
