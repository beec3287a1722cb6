//! A control law in the terms of a controller's manual.
//!
//! ```text
//! PI              K_p (1 + 1/(T_i s))
//! PID             K_p (1 + 1/(T_i s) + T_d s/(T_f s + 1))
//! low pass        1/(T_f s + 1)
//! lead, lag       (s/z + 1)/(s/p + 1)
//! notch           (s^2/w^2 + 2 D_z s/w + 1)/(s^2/w^2 + 2 D_p s/w + 1)
//!                 depth 20 log10(D_z/D_p) at w, width 2 D_p w, of its poles
//! ```
//!
//! The parts are in series.

mod roots;

use phea_dynamics::controller::{Compensator, Element, NamedStructure};

use self::roots::{Pair, Roots};
use crate::project::{DeclaredElement, ElementKind};

/// Relative difference of natural frequencies below which zeros and poles count as at one
/// frequency.
const SAME: f64 = 1e-12;
/// Ratio of the natural frequencies of zeros and poles within which they form a notch.
const NEARBY: f64 = 2.0;

/// Parts in series, the one with the gain first.
#[derive(Clone, Debug, PartialEq)]
pub struct ManualLaw {
    /// Parts of the law.
    pub parts: Vec<ManualPart>,
}

/// A part of a controller, in the terms of manuals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ManualPart {
    /// Gain K_p.
    Proportional {
        /// Gain K_p.
        gain: f64,
    },
    /// Integrator K_i/s.
    Integral {
        /// Gain K_i, 1/s.
        gain: f64,
    },
    /// PI controller K_p (1 + 1/(T_i s)).
    ProportionalIntegral {
        /// Gain K_p.
        gain: f64,
        /// Integral time T_i, s.
        integral_time_s: f64,
    },
    /// PID controller K_p (1 + 1/(T_i s) + T_d s/(T_f s + 1)).
    ProportionalIntegralDerivative {
        /// Gain K_p.
        gain: f64,
        /// Integral time T_i, s.
        integral_time_s: f64,
        /// Derivative time T_d, s.
        derivative_time_s: f64,
        /// Filter time T_f, s.
        filter_time_s: f64,
    },
    /// Low pass 1/(T_f s + 1).
    LowPass {
        /// Time constant T_f, s.
        time_s: f64,
    },
    /// Second-order low pass 1/(s^2/w^2 + 2 D s/w + 1).
    SecondOrderLowPass {
        /// Natural frequency w, rad/s.
        frequency_rad_per_s: f64,
        /// Damping ratio D.
        damping_ratio: f64,
    },
    /// Lead (s/z + 1)/(s/p + 1) with z < p.
    Lead {
        /// Zero z, rad/s.
        zero_rad_per_s: f64,
        /// Pole p, rad/s.
        pole_rad_per_s: f64,
    },
    /// Lag (s/z + 1)/(s/p + 1) with z > p.
    Lag {
        /// Zero z, rad/s.
        zero_rad_per_s: f64,
        /// Pole p, rad/s.
        pole_rad_per_s: f64,
    },
    /// A pair of zeros over a pair of poles at equal or similar frequencies.
    Notch {
        /// Natural frequency w of the zeros, rad/s.
        frequency_rad_per_s: f64,
        /// Natural frequency w of the poles, rad/s.
        pole_frequency_rad_per_s: f64,
        /// Damping ratio D_z of the zeros.
        zero_damping_ratio: f64,
        /// Damping ratio D_p of the poles.
        pole_damping_ratio: f64,
    },
}

/// Reason why a law has no description in these terms.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ManualGap {
    /// The law is a function of z.
    #[error("the law is given in z, and manuals state continuous ones")]
    Sampled,
    /// A part of the law is not a finite transfer function without dead time.
    #[error("the law is not a ratio of polynomials without dead time")]
    NotRational,
    /// The law has more than one integrator, or a differentiator.
    #[error("the law has more than one integrator, or it differentiates")]
    Origin,
    /// The law has roots on the imaginary axis or in the right half plane.
    #[error("the law has zeros or poles on the imaginary axis or in the right half plane")]
    NotMinimumPhase,
    /// The law has zeros that belong to no poles.
    #[error(
        "the law has zeros that no part of a manual takes: a pair without poles near it, or more zeros than single poles"
    )]
    Zeros,
}

impl ManualLaw {
    /// Description of a law; one that was designed as a named structure is described in the terms
    /// of that name.
    ///
    /// # Errors
    /// [`ManualGap`] for a law that cannot be composed of such parts.
    pub fn new(law: &Compensator, name: Option<NamedStructure>) -> Result<ManualLaw, ManualGap> {
        let mut roots = Roots::of(law)?;
        let mut behind = roots.notches.clone();
        let mut parts = vec![];
        for zeros in std::mem::take(&mut roots.zero_pairs) {
            match roots.poles_near(zeros, NEARBY) {
                Some(poles) => behind.push(notch(zeros, poles)),
                None => roots.zero_pairs.push(zeros),
            }
        }
        parts.push(first(&mut roots, name)?);
        if !roots.zero_pairs.is_empty() {
            return Err(ManualGap::Zeros);
        }
        behind.sort_by(|one, other| frequency(one).total_cmp(&frequency(other)));
        for zero in std::mem::take(&mut roots.zeros) {
            let pole = roots.pole_nearest(zero).ok_or(ManualGap::Zeros)?;
            behind.push(lead_or_lag(zero, pole));
        }
        behind.extend(roots.poles.iter().map(|pole| ManualPart::LowPass { time_s: 1.0 / pole }));
        behind.extend(roots.pole_pairs.iter().map(|pair| ManualPart::SecondOrderLowPass {
            frequency_rad_per_s: pair.frequency,
            damping_ratio: pair.damping,
        }));
        parts.extend(behind);
        Ok(ManualLaw { parts })
    }

    /// Compensator with these parts.
    pub fn compensator(&self) -> Compensator {
        Compensator::new(self.parts.iter().flat_map(ManualPart::elements).collect())
    }

    /// Elements of a project with these parts.
    pub fn declared(&self) -> Vec<DeclaredElement> {
        self.parts.iter().flat_map(ManualPart::declared).map(DeclaredElement::new).collect()
    }
}

impl ManualPart {
    fn elements(&self) -> Vec<Element> {
        match *self {
            ManualPart::Proportional { gain } => vec![Element::Gain(gain)],
            ManualPart::Integral { gain } => vec![Element::Gain(gain), Element::Integrator],
            ManualPart::ProportionalIntegral { gain, integral_time_s } => {
                vec![Element::ProportionalIntegral {
                    proportional_gain: gain,
                    integral_gain: gain / integral_time_s,
                }]
            }
            ManualPart::ProportionalIntegralDerivative {
                gain,
                integral_time_s,
                derivative_time_s,
                filter_time_s,
            } => vec![Element::ProportionalIntegralDerivative {
                proportional_gain: gain,
                integral_gain: gain / integral_time_s,
                derivative_gain: gain * derivative_time_s,
                filter_time: filter_time_s,
            }],
            ManualPart::LowPass { time_s } => vec![Element::RealPole { frequency: 1.0 / time_s }],
            ManualPart::SecondOrderLowPass { frequency_rad_per_s, damping_ratio } => {
                vec![Element::ComplexPoles { natural_frequency: frequency_rad_per_s, damping_ratio }]
            }
            ManualPart::Lead { zero_rad_per_s, pole_rad_per_s }
            | ManualPart::Lag { zero_rad_per_s, pole_rad_per_s } => {
                vec![Element::LeadLag { zero_frequency: zero_rad_per_s, pole_frequency: pole_rad_per_s }]
            }
            ManualPart::Notch {
                frequency_rad_per_s,
                pole_frequency_rad_per_s,
                zero_damping_ratio,
                pole_damping_ratio,
            } if frequency_rad_per_s == pole_frequency_rad_per_s => vec![Element::Notch {
                natural_frequency: frequency_rad_per_s,
                zero_damping_ratio,
                pole_damping_ratio,
            }],
            ManualPart::Notch {
                frequency_rad_per_s,
                pole_frequency_rad_per_s,
                zero_damping_ratio,
                pole_damping_ratio,
            } => vec![
                Element::ComplexZeros {
                    natural_frequency: frequency_rad_per_s,
                    damping_ratio: zero_damping_ratio,
                },
                Element::ComplexPoles {
                    natural_frequency: pole_frequency_rad_per_s,
                    damping_ratio: pole_damping_ratio,
                },
            ],
        }
    }

    fn declared(&self) -> Vec<ElementKind> {
        let declared = |element: Element| match element {
            Element::Gain(value) => Some(ElementKind::Gain { value }),
            Element::Integrator => Some(ElementKind::Integrator),
            Element::RealPole { frequency } => Some(ElementKind::Pole { frequency }),
            Element::ComplexPoles { natural_frequency, damping_ratio } => match self {
                ManualPart::SecondOrderLowPass { .. } => Some(ElementKind::RollOff {
                    frequency: natural_frequency,
                    damping_ratio: Some(damping_ratio),
                }),
                _ => Some(ElementKind::ComplexPoles { frequency: natural_frequency, damping_ratio }),
            },
            Element::ComplexZeros { natural_frequency, damping_ratio } => {
                Some(ElementKind::ComplexZeros { frequency: natural_frequency, damping_ratio })
            }
            Element::LeadLag { zero_frequency, pole_frequency } if zero_frequency > pole_frequency => {
                Some(ElementKind::Lag { zero_frequency, pole_frequency })
            }
            Element::LeadLag { zero_frequency, pole_frequency } => {
                Some(ElementKind::Lead { zero_frequency, pole_frequency })
            }
            Element::Notch { natural_frequency, zero_damping_ratio, pole_damping_ratio } => {
                Some(ElementKind::Notch {
                    frequency: natural_frequency,
                    damping_ratio: pole_damping_ratio,
                    numerator_damping_ratio: zero_damping_ratio,
                })
            }
            Element::ProportionalIntegral { proportional_gain, integral_gain } => {
                Some(ElementKind::ProportionalIntegral { proportional_gain, integral_gain })
            }
            Element::ProportionalIntegralDerivative {
                proportional_gain,
                integral_gain,
                derivative_gain,
                filter_time,
            } => Some(ElementKind::ProportionalIntegralDerivative {
                proportional_gain,
                integral_gain,
                derivative_gain,
                filter_time,
            }),
            // no part consists of these elements
            Element::Differentiator | Element::RealZero { .. } | Element::General(_) => None,
        };
        self.elements().into_iter().filter_map(declared).collect()
    }
}

/// Part with the gain: a PID if the structure is one, or two zeros require it.
fn first(roots: &mut Roots, name: Option<NamedStructure>) -> Result<ManualPart, ManualGap> {
    let gain = roots.gain;
    match roots.integrators {
        0 => return Ok(ManualPart::Proportional { gain }),
        1 => {}
        _ => return Err(ManualGap::Origin),
    }
    let is_pid = name == Some(NamedStructure::Pid) || !roots.zero_pairs.is_empty();
    if let Some(pid) = is_pid.then(|| roots.pid()).flatten() {
        return Ok(pid);
    }
    Ok(match roots.slowest_zero() {
        // k (s/z + 1)/s
        Some(zero) => ManualPart::ProportionalIntegral { gain: gain / zero, integral_time_s: 1.0 / zero },
        None => ManualPart::Integral { gain },
    })
}

fn notch(zeros: Pair, poles: Pair) -> ManualPart {
    let same = (zeros.frequency / poles.frequency - 1.0).abs() <= SAME;
    ManualPart::Notch {
        frequency_rad_per_s: zeros.frequency,
        pole_frequency_rad_per_s: if same { zeros.frequency } else { poles.frequency },
        zero_damping_ratio: zeros.damping,
        pole_damping_ratio: poles.damping,
    }
}

fn frequency(part: &ManualPart) -> f64 {
    match part {
        ManualPart::Notch { frequency_rad_per_s, .. } => *frequency_rad_per_s,
        _ => 0.0,
    }
}

fn lead_or_lag(zero_rad_per_s: f64, pole_rad_per_s: f64) -> ManualPart {
    match zero_rad_per_s <= pole_rad_per_s {
        true => ManualPart::Lead { zero_rad_per_s, pole_rad_per_s },
        false => ManualPart::Lag { zero_rad_per_s, pole_rad_per_s },
    }
}

#[cfg(test)]
mod tests;
