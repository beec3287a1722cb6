use num_complex::Complex64;

use crate::linear::{LinearError, TransferFunction};

/// A building block of loop shaping. Frequencies in rad/s; every block but gain, integrator and
/// differentiator has unit gain at zero frequency, so that adding one leaves the loop unchanged
/// there.
#[derive(Clone, Debug, PartialEq)]
pub enum Element {
    /// k
    Gain(f64),
    /// 1/s
    Integrator,
    /// s
    Differentiator,
    /// 1/(s/p + 1)
    RealPole {
        /// p
        frequency: f64,
    },
    /// s/z + 1
    RealZero {
        /// z
        frequency: f64,
    },
    /// 1/(s^2/w^2 + 2 zeta s/w + 1)
    ComplexPoles {
        /// w
        natural_frequency: f64,
        /// zeta
        damping_ratio: f64,
    },
    /// s^2/w^2 + 2 zeta s/w + 1
    ComplexZeros {
        /// w
        natural_frequency: f64,
        /// zeta
        damping_ratio: f64,
    },
    /// (s/z + 1)/(s/p + 1): leads where z < p, lags where z > p
    LeadLag {
        /// z
        zero_frequency: f64,
        /// p
        pole_frequency: f64,
    },
    /// (s^2/w^2 + 2 zeta_z s/w + 1)/(s^2/w^2 + 2 zeta_p s/w + 1)
    Notch {
        /// w
        natural_frequency: f64,
        /// Damping ratio zeta_z; the depth is zeta_z/zeta_p.
        zero_damping_ratio: f64,
        /// zeta_p
        pole_damping_ratio: f64,
    },
    /// K_p + K_i/s
    ProportionalIntegral {
        /// K_p
        proportional_gain: f64,
        /// K_i in 1/s
        integral_gain: f64,
    },
    /// K_p + K_i/s + K_d s/(T_f s + 1)
    ProportionalIntegralDerivative {
        /// K_p
        proportional_gain: f64,
        /// K_i in 1/s
        integral_gain: f64,
        /// K_d in s
        derivative_gain: f64,
        /// T_f in s, positive
        filter_time: f64,
    },
    /// General rational function.
    General(TransferFunction),
}

/// An element that can be disabled without being deleted.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// The element.
    pub element: Element,
    /// True if the element acts.
    pub enabled: bool,
}

/// Elements in series; an empty series is the gain 1.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Compensator {
    /// The elements, in the order in which they were added.
    pub stages: Vec<Stage>,
}

impl Compensator {
    /// Compensator of these elements, all enabled.
    pub fn new(elements: Vec<Element>) -> Compensator {
        Compensator { stages: elements.into_iter().map(|element| Stage { element, enabled: true }).collect() }
    }

    /// Product of the enabled elements. A gain is identical in s and in z, and so combines with
    /// elements of either domain.
    ///
    /// # Errors
    /// Frequency of zero or a number that is not finite; elements in different time domains.
    pub fn transfer_function(&self) -> Result<TransferFunction, LinearError> {
        let enabled = self.stages.iter().filter(|stage| stage.enabled).map(|stage| &stage.element);
        let (gains, others): (Vec<&Element>, Vec<&Element>) =
            enabled.partition(|element| matches!(element, Element::Gain(_)));
        let mut others = others.into_iter();
        let first = others
            .next()
            .map_or(Ok(TransferFunction::gain_only(1.0)), |element| element.transfer_function())?;
        let product =
            others.try_fold(first, |product, element| product.series(&element.transfer_function()?))?;
        gains.into_iter().try_fold(product, |product, gain| {
            product.series(&gain.transfer_function()?.in_domain(product.domain())?)
        })
    }
}

impl Element {
    /// Transfer function of the element.
    ///
    /// # Errors
    /// Frequency of zero or a number that is not finite.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::controller::Element;
    /// let notch = Element::Notch { natural_frequency: 50.0, zero_damping_ratio: 0.1, pole_damping_ratio: 0.5 };
    /// let depth = notch.transfer_function()?.at_frequency(50.0);
    /// assert!((depth.re - 0.2).abs() < 1e-12 && depth.im.abs() < 1e-12);
    /// # Ok::<(), phea_dynamics::linear::LinearError>(())
    /// ```
    pub fn transfer_function(&self) -> Result<TransferFunction, LinearError> {
        let real = |root: f64| vec![Complex64::new(root, 0.0)];
        match *self {
            Element::Gain(gain) => TransferFunction::from_factors(gain, vec![], vec![]),
            Element::Integrator => TransferFunction::from_factors(1.0, vec![], real(0.0)),
            Element::Differentiator => TransferFunction::from_factors(1.0, real(0.0), vec![]),
            Element::RealPole { frequency } => {
                TransferFunction::from_factors(frequency, vec![], real(-frequency))
            }
            Element::RealZero { frequency } => {
                TransferFunction::from_factors(1.0 / frequency, real(-frequency), vec![])
            }
            Element::ComplexPoles { natural_frequency: w, damping_ratio } => {
                TransferFunction::from_factors(w * w, vec![], quadratic_roots(w, damping_ratio))
            }
            Element::ComplexZeros { natural_frequency: w, damping_ratio } => {
                TransferFunction::from_factors(1.0 / (w * w), quadratic_roots(w, damping_ratio), vec![])
            }
            Element::LeadLag { zero_frequency, pole_frequency } => {
                let gain = pole_frequency / zero_frequency;
                TransferFunction::from_factors(gain, real(-zero_frequency), real(-pole_frequency))
            }
            Element::Notch { natural_frequency: w, zero_damping_ratio, pole_damping_ratio } => {
                let zeros = quadratic_roots(w, zero_damping_ratio);
                TransferFunction::from_factors(1.0, zeros, quadratic_roots(w, pole_damping_ratio))
            }
            Element::ProportionalIntegral { proportional_gain, integral_gain } => {
                proportional_integral(proportional_gain, integral_gain)
            }
            Element::ProportionalIntegralDerivative {
                proportional_gain,
                integral_gain,
                derivative_gain,
                filter_time,
            } => {
                let derivative = TransferFunction::from_factors(
                    derivative_gain / filter_time,
                    real(0.0),
                    real(-1.0 / filter_time),
                )?;
                proportional_integral(proportional_gain, integral_gain)?.parallel(&derivative)
            }
            Element::General(ref function) => Ok(function.clone()),
        }
    }
}

fn proportional_integral(
    proportional_gain: f64,
    integral_gain: f64,
) -> Result<TransferFunction, LinearError> {
    let pole = vec![Complex64::new(0.0, 0.0)];
    if integral_gain == 0.0 {
        return TransferFunction::from_factors(proportional_gain, vec![], vec![]);
    }
    if proportional_gain == 0.0 {
        return TransferFunction::from_factors(integral_gain, vec![], pole);
    }
    let zero = Complex64::new(-integral_gain / proportional_gain, 0.0);
    TransferFunction::from_factors(proportional_gain, vec![zero], pole)
}

/// Roots of s^2 + 2 zeta w s + w^2, without cancellation when they are real.
fn quadratic_roots(natural_frequency: f64, damping_ratio: f64) -> Vec<Complex64> {
    let centre = -damping_ratio * natural_frequency;
    let discriminant = (damping_ratio - 1.0) * (damping_ratio + 1.0);
    let spread = natural_frequency.abs() * discriminant.abs().sqrt();
    if discriminant < 0.0 {
        return vec![Complex64::new(centre, spread), Complex64::new(centre, -spread)];
    }
    let larger = centre + spread * 1.0_f64.copysign(centre);
    let smaller = if larger == 0.0 { 0.0 } else { natural_frequency * natural_frequency / larger };
    vec![Complex64::new(larger, 0.0), Complex64::new(smaller, 0.0)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::TimeDomain;
    use crate::portable;

    fn at(element: Element, frequency: f64) -> Complex64 {
        element.transfer_function().unwrap().at_frequency(frequency)
    }

    /// Elements agree with their formulas at s = j w.
    #[test]
    fn elements_are_their_formulas() {
        let w = 7.0;
        let s = Complex64::new(0.0, w);
        let quadratic = |n: f64, zeta: f64| s * s / (n * n) + 2.0 * zeta * s / n + 1.0;
        for (element, expected) in [
            (Element::Gain(-2.0), Complex64::new(-2.0, 0.0)),
            (Element::Integrator, 1.0 / s),
            (Element::Differentiator, s),
            (Element::RealPole { frequency: 3.0 }, 1.0 / (s / 3.0 + 1.0)),
            (Element::RealZero { frequency: -3.0 }, s / -3.0 + 1.0),
            (Element::ComplexPoles { natural_frequency: 5.0, damping_ratio: 0.3 }, 1.0 / quadratic(5.0, 0.3)),
            (Element::ComplexPoles { natural_frequency: 5.0, damping_ratio: 1e4 }, 1.0 / quadratic(5.0, 1e4)),
            (Element::ComplexZeros { natural_frequency: 5.0, damping_ratio: 1.0 }, quadratic(5.0, 1.0)),
            (
                Element::LeadLag { zero_frequency: 2.0, pole_frequency: 9.0 },
                (s / 2.0 + 1.0) / (s / 9.0 + 1.0),
            ),
            (
                Element::ProportionalIntegralDerivative {
                    proportional_gain: 2.0,
                    integral_gain: 3.0,
                    derivative_gain: 0.5,
                    filter_time: 0.1,
                },
                2.0 + 3.0 / s + 0.5 * s / (0.1 * s + 1.0),
            ),
        ] {
            let error = portable::magnitude(at(element.clone(), w) - expected);
            assert!(error < 1e-12 * portable::magnitude(expected), "{element:?}: {error}");
        }
    }

    #[test]
    fn a_disabled_element_does_not_act() {
        let mut compensator =
            Compensator::new(vec![Element::Gain(2.0), Element::Integrator, Element::Gain(3.0)]);
        compensator.stages[1].enabled = false;
        let function = compensator.transfer_function().unwrap();
        assert_eq!((function.gain(), function.poles().len()), (6.0, 0));
        assert_eq!(Compensator::default().transfer_function().unwrap().gain(), 1.0);
    }

    #[test]
    fn a_gain_joins_elements_in_z() {
        let domain = TimeDomain::Discrete { sample_time_s: 0.01 };
        let delay = TransferFunction::from_factors(1.0, vec![], vec![Complex64::new(0.0, 0.0)]).unwrap();
        let delay = Element::General(delay.in_domain(domain).unwrap());
        let scaled = Compensator::new(vec![Element::Gain(2.0), delay.clone()]).transfer_function().unwrap();
        assert_eq!((scaled.gain(), scaled.domain()), (2.0, domain));
        let mixed = Compensator::new(vec![Element::Integrator, delay]);
        assert_eq!(mixed.transfer_function(), Err(LinearError::DomainMismatch));
    }

    #[test]
    fn a_frequency_of_zero_is_refused() {
        assert!(Element::RealZero { frequency: 0.0 }.transfer_function().is_err());
        assert!(Element::LeadLag { zero_frequency: 0.0, pole_frequency: 1.0 }.transfer_function().is_err());
    }
}
