//! Elements in series.

use std::collections::BTreeMap;

use super::RationalFunction;
use crate::printer::Printer;
use phea_quantity::{ANGULAR_FREQUENCY, RATIO, TIME};
use phea_table::{Key, key, plain};
use phea_table::{Variants, Visitor};

/// Element of a controller; every kind but gain, `pi`, `pid` and `general` has unit gain at zero
/// frequency (integrator and differentiator: at 1 rad/s).
#[derive(Clone, Debug, PartialEq)]
pub struct DeclaredElement {
    /// Kind of element.
    pub kind: ElementKind,
    /// True if it is active; a disabled element stays in the list.
    pub enabled: bool,
}

/// Kind of element, with its numbers: frequencies ω in rad/s, damping ratios ζ.
#[derive(Clone, Debug, PartialEq)]
pub enum ElementKind {
    /// Factor.
    Gain {
        /// Value of the factor.
        value: f64,
    },
    /// 1/s.
    Integrator,
    /// s.
    Differentiator,
    /// 1 + s/ω.
    Zero {
        /// ω.
        frequency: f64,
    },
    /// 1/(1 + s/ω).
    Pole {
        /// ω.
        frequency: f64,
    },
    /// 1 + 2ζs/ω + s²/ω².
    ComplexZeros {
        /// ω.
        frequency: f64,
        /// ζ.
        damping_ratio: f64,
    },
    /// 1/(1 + 2ζs/ω + s²/ω²).
    ComplexPoles {
        /// ω.
        frequency: f64,
        /// ζ.
        damping_ratio: f64,
    },
    /// (1 + s/ω_z)/(1 + s/ω_p); lags where ω_z > ω_p.
    Lead {
        /// ω_z.
        zero_frequency: f64,
        /// ω_p.
        pole_frequency: f64,
    },
    /// (1 + s/ω_z)/(1 + s/ω_p), ω_z > ω_p.
    Lag {
        /// ω_z.
        zero_frequency: f64,
        /// ω_p.
        pole_frequency: f64,
    },
    /// (s² + 2ζ_z ωs + ω²)/(s² + 2ζ_p ωs + ω²).
    Notch {
        /// ω.
        frequency: f64,
        /// ζ_p.
        damping_ratio: f64,
        /// ζ_z.
        numerator_damping_ratio: f64,
    },
    /// 1/(1 + 2ζs/ω + s²/ω²) at high frequency.
    RollOff {
        /// ω.
        frequency: f64,
        /// ζ; absent: 1/√2.
        damping_ratio: Option<f64>,
    },
    /// K_p + K_i/s.
    ProportionalIntegral {
        /// K_p.
        proportional_gain: f64,
        /// K_i, 1/s.
        integral_gain: f64,
    },
    /// K_p + K_i/s + K_d s/(T_f s + 1).
    ProportionalIntegralDerivative {
        /// K_p.
        proportional_gain: f64,
        /// K_i, 1/s.
        integral_gain: f64,
        /// K_d, s.
        derivative_gain: f64,
        /// T_f, s.
        filter_time: f64,
    },
    /// A ratio of polynomials.
    General(RationalFunction),
}

impl Default for DeclaredElement {
    fn default() -> Self {
        DeclaredElement::new(ElementKind::Gain { value: 0.0 })
    }
}

impl ElementKind {
    /// Word in the project file.
    pub fn name(&self) -> &'static str {
        self.word()
    }
}

impl Variants for ElementKind {
    const STRICT: bool = true;

    fn all(&self) -> Vec<ElementKind> {
        let (frequency, damping_ratio) = (0.0, 0.0);
        let (zero_frequency, pole_frequency) = (0.0, 0.0);
        let (proportional_gain, integral_gain) = (0.0, 0.0);
        vec![
            ElementKind::Gain { value: 0.0 },
            ElementKind::Integrator,
            ElementKind::Differentiator,
            ElementKind::Zero { frequency },
            ElementKind::Pole { frequency },
            ElementKind::ComplexZeros { frequency, damping_ratio },
            ElementKind::ComplexPoles { frequency, damping_ratio },
            ElementKind::Lead { zero_frequency, pole_frequency },
            ElementKind::Lag { zero_frequency, pole_frequency },
            ElementKind::Notch { frequency, damping_ratio, numerator_damping_ratio: 0.0 },
            ElementKind::RollOff { frequency, damping_ratio: None },
            ElementKind::ProportionalIntegral { proportional_gain, integral_gain },
            ElementKind::ProportionalIntegralDerivative {
                proportional_gain,
                integral_gain,
                derivative_gain: 0.0,
                filter_time: 0.0,
            },
            ElementKind::General(RationalFunction::default()),
        ]
    }

    fn word(&self) -> &'static str {
        match self {
            ElementKind::Gain { .. } => "gain",
            ElementKind::Integrator => "integrator",
            ElementKind::Differentiator => "differentiator",
            ElementKind::Zero { .. } => "zero",
            ElementKind::Pole { .. } => "pole",
            ElementKind::ComplexZeros { .. } => "complex_zeros",
            ElementKind::ComplexPoles { .. } => "complex_poles",
            ElementKind::Lead { .. } => "lead",
            ElementKind::Lag { .. } => "lag",
            ElementKind::Notch { .. } => "notch",
            ElementKind::RollOff { .. } => "roll_off",
            ElementKind::ProportionalIntegral { .. } => "pi",
            ElementKind::ProportionalIntegralDerivative { .. } => "pid",
            ElementKind::General(_) => "general",
        }
    }

    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let corner = key("frequency", &ANGULAR_FREQUENCY, "Corner or natural frequency.").positive();
        let doc = "Of a complex pair, a notch's denominator or a roll-off.";
        let damping = key("damping_ratio", &RATIO, doc).not_negative();
        match self {
            ElementKind::Gain { value } => v.quantity(key("value", &RATIO, "Of a gain."), value),
            ElementKind::Integrator | ElementKind::Differentiator => {}
            ElementKind::Zero { frequency } | ElementKind::Pole { frequency } => {
                v.quantity(corner, frequency)
            }
            ElementKind::ComplexZeros { frequency, damping_ratio }
            | ElementKind::ComplexPoles { frequency, damping_ratio } => {
                v.quantity(corner, frequency);
                v.quantity(damping, damping_ratio);
            }
            ElementKind::Lead { zero_frequency, pole_frequency }
            | ElementKind::Lag { zero_frequency, pole_frequency } => {
                let k =
                    key("zero_frequency", &ANGULAR_FREQUENCY, "Corner of the numerator of a lead or lag.");
                v.quantity(k.positive(), zero_frequency);
                let k =
                    key("pole_frequency", &ANGULAR_FREQUENCY, "Corner of the denominator of a lead or lag.");
                v.quantity(k.positive(), pole_frequency);
            }
            ElementKind::Notch { frequency, damping_ratio, numerator_damping_ratio } => {
                v.quantity(corner, frequency);
                v.quantity(damping, damping_ratio);
                let k = key("numerator_damping_ratio", &RATIO, "Of a notch's numerator.").not_negative();
                v.quantity(k, numerator_damping_ratio);
            }
            ElementKind::RollOff { frequency, damping_ratio } => {
                v.quantity(corner, frequency);
                v.optional(damping, damping_ratio);
            }
            ElementKind::ProportionalIntegral { proportional_gain, integral_gain } => {
                v.quantity(PROPORTIONAL, proportional_gain);
                v.quantity(INTEGRAL, integral_gain);
            }
            ElementKind::ProportionalIntegralDerivative {
                proportional_gain,
                integral_gain,
                derivative_gain,
                filter_time,
            } => {
                v.quantity(PROPORTIONAL, proportional_gain);
                v.quantity(INTEGRAL, integral_gain);
                v.quantity(key("derivative_gain", &RATIO, "Of a PID, in seconds."), derivative_gain);
                let k = key("filter_time", &TIME, "Time constant of the derivative of a PID.").positive();
                v.quantity(k, filter_time);
            }
            ElementKind::General(ratio) => ratio.visit(v),
        }
    }
}

const PROPORTIONAL: Key = key("proportional_gain", &RATIO, "Of a PI or PID.");
const INTEGRAL: Key = key("integral_gain", &RATIO, "Of a PI or PID, for each second.");

impl DeclaredElement {
    /// Active element of this kind.
    pub fn new(kind: ElementKind) -> DeclaredElement {
        DeclaredElement { kind, enabled: true }
    }

    /// True if it is written in `z`.
    pub fn is_sampled(&self) -> bool {
        matches!(&self.kind, ElementKind::General(ratio) if ratio.is_sampled())
    }

    /// Element as an inline table of the project file, which reads back as an equal element.
    ///
    /// # Example
    /// ```
    /// use phea_project::{DeclaredElement, ElementKind};
    /// let zero = DeclaredElement { kind: ElementKind::Zero { frequency: 20.0 }, enabled: false };
    /// assert_eq!(zero.print(), r#"{ kind = "zero", frequency = "20 rad/s", enabled = false }"#);
    /// ```
    pub fn print(&self) -> String {
        let mut printer = Printer::new(BTreeMap::new());
        self.clone().visit(&mut printer);
        printer.finish_inline().unwrap_or_default()
    }

    /// Element as the lines of its own table.
    pub fn print_lines(&self) -> String {
        let mut printer = Printer::new(BTreeMap::new());
        self.clone().visit(&mut printer);
        printer.finish()
    }

    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        v.variant(plain("kind", "Which element."), &mut self.kind, true);
        v.switch(plain("enabled", "Whether it acts."), &mut self.enabled);
    }
}
