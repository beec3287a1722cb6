//! `[controller]` and `[prefilter]`.

use super::formula::{Formula, Variable};
use super::key::{key, plain};
use super::visitor::{Shape, Visitor};
use crate::quantity::{ANGULAR_FREQUENCY, FORCE, RATIO, TIME, VOLTAGE};

/// A transfer function in one of three forms: polynomials, factors, or elements in series.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Transfer {
    /// Polynomial in `s`, or in `z` when it is sampled.
    pub numerator: Option<Formula>,
    /// Polynomial in `s`, or in `z` when it is sampled.
    pub denominator: Option<Formula>,
    /// Leading coefficient k of k Π(s - z)/Π(s - p).
    pub gain: Option<f64>,
    /// Real and imaginary parts, 1/s.
    pub zeros: Vec<[f64; 2]>,
    /// Real and imaginary parts, 1/s.
    pub poles: Vec<[f64; 2]>,
    /// Whether gain, zeros and poles are in s (absent) or in z.
    pub domain: Option<Variable>,
    /// Elements in series.
    pub elements: Vec<Element>,
}

/// The words of `domain`.
static DOMAINS: [(&str, Option<Variable>); 2] = [("s", Some(Variable::S)), ("z", Some(Variable::Z))];

/// Which of its forms a [`Transfer`] is written in.
#[derive(Clone, Debug, PartialEq)]
pub enum TransferForm<'a> {
    /// Polynomials.
    Polynomials {
        /// As written.
        numerator: &'a Formula,
        /// As written.
        denominator: &'a Formula,
    },
    /// k Π(s - z)/Π(s - p).
    Factors {
        /// k.
        gain: f64,
        /// Real and imaginary parts.
        zeros: &'a [[f64; 2]],
        /// Real and imaginary parts.
        poles: &'a [[f64; 2]],
        /// Whether they are in z.
        is_discrete: bool,
    },
    /// In series.
    Elements(&'a [Element]),
}

impl Transfer {
    /// The form it is written in; `None` only for one that was not read from a valid project.
    pub fn form(&self) -> Option<TransferForm<'_>> {
        if let (Some(numerator), Some(denominator)) = (&self.numerator, &self.denominator) {
            return Some(TransferForm::Polynomials { numerator, denominator });
        }
        if let Some(gain) = self.gain {
            let is_discrete = self.domain == Some(Variable::Z);
            return Some(TransferForm::Factors { gain, zeros: &self.zeros, poles: &self.poles, is_discrete });
        }
        if self.elements.is_empty() { None } else { Some(TransferForm::Elements(&self.elements)) }
    }

    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = plain("numerator", "Polynomial in s, or in z when sampled.");
        v.formula(k, Shape::Polynomial, &mut self.numerator, false);
        let k = plain("denominator", "Polynomial in s, or in z when sampled.");
        v.formula(k, Shape::Polynomial, &mut self.denominator, false);
        let k = key("gain", &RATIO, "Leading coefficient: k of k prod(s - z)/prod(s - p).");
        v.optional(k, &mut self.gain);
        v.complexes(
            key("zeros", &RATIO, "Numbers, or [re, im] pairs with their conjugates."),
            &mut self.zeros,
        );
        v.complexes(
            key("poles", &RATIO, "Numbers, or [re, im] pairs with their conjugates."),
            &mut self.poles,
        );
        let k = plain("domain", "Of gain, zeros and poles: in s, or in z when sampled.");
        v.choice(k, &DOMAINS, &mut self.domain, false);
        v.tables(plain("elements", "Elements in series."), &mut self.elements, Element::visit);
    }
}

/// One element of a controller; every kind but the gain has unit gain at zero frequency (integrator and
/// differentiator: at 1 rad/s).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Element {
    /// Which element.
    pub kind: ElementKind,
    /// Of a gain.
    pub value: Option<f64>,
    /// rad/s: corner or natural frequency.
    pub frequency: Option<f64>,
    /// Of a complex pair, or of a notch's denominator.
    pub damping_ratio: Option<f64>,
    /// Of a notch's numerator.
    pub numerator_damping_ratio: Option<f64>,
    /// rad/s, corner of a lead's numerator.
    pub zero_frequency: Option<f64>,
    /// rad/s, corner of a lead's denominator.
    pub pole_frequency: Option<f64>,
}

/// Which element.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ElementKind {
    /// `value`.
    #[default]
    Gain,
    /// 1/s.
    Integrator,
    /// s.
    Differentiator,
    /// 1 + s/ω.
    Zero,
    /// 1/(1 + s/ω).
    Pole,
    /// 1 + 2ζs/ω + s²/ω².
    ComplexZeros,
    /// 1/(1 + 2ζs/ω + s²/ω²).
    ComplexPoles,
    /// (1 + s/ω_z)/(1 + s/ω_p), lead or lag.
    Lead,
    /// (s² + 2ζ_z ωs + ω²)/(s² + 2ζ_p ωs + ω²).
    Notch,
}

impl Element {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let words = &[
            ("gain", ElementKind::Gain),
            ("integrator", ElementKind::Integrator),
            ("differentiator", ElementKind::Differentiator),
            ("zero", ElementKind::Zero),
            ("pole", ElementKind::Pole),
            ("complex_zeros", ElementKind::ComplexZeros),
            ("complex_poles", ElementKind::ComplexPoles),
            ("lead", ElementKind::Lead),
            ("notch", ElementKind::Notch),
        ];
        v.choice(plain("kind", "Which element."), words, &mut self.kind, true);
        v.optional(key("value", &RATIO, "Of a gain."), &mut self.value);
        let k = key("frequency", &ANGULAR_FREQUENCY, "Corner or natural frequency.");
        v.optional(k.positive(), &mut self.frequency);
        let k = key("damping_ratio", &RATIO, "Of a complex pair or of a notch's denominator.").not_negative();
        v.optional(k, &mut self.damping_ratio);
        let k = key("numerator_damping_ratio", &RATIO, "Of a notch's numerator.").not_negative();
        v.optional(k, &mut self.numerator_damping_ratio);
        let k = key("zero_frequency", &ANGULAR_FREQUENCY, "Corner of a lead's numerator.").positive();
        v.optional(k, &mut self.zero_frequency);
        let k = key("pole_frequency", &ANGULAR_FREQUENCY, "Corner of a lead's denominator.").positive();
        v.optional(k, &mut self.pole_frequency);
    }
}

/// The controller as declared.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Controller {
    /// From force error to command.
    pub transfer: Transfer,
    /// V (or the plant's input unit), limit of the command.
    pub saturation: Option<f64>,
    /// What happens to the integrator at the limit.
    pub anti_windup: AntiWindup,
    /// s; absent: continuous.
    pub sample_time: Option<f64>,
    /// s, computation and transport delay of the loop.
    pub delay: f64,
    /// How a continuous controller becomes a sampled one.
    pub discretization: Discretization,
    /// What its computer rounds; absent: nothing.
    pub quantization: Option<Quantization>,
}

/// What the computer of a sampled controller rounds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Quantization {
    /// Of the converter of the command; 0: it does not round.
    pub command_bits: u32,
    /// V (or the plant's input unit), from and to.
    pub command_range: Option<[f64; 2]>,
    /// Of the converter of the measurement; 0: it does not round.
    pub measurement_bits: u32,
    /// N (or the plant's output unit), from and to.
    pub measurement_range: Option<[f64; 2]>,
    /// How the coefficients are kept.
    pub coefficients: Coefficients,
}

/// How coefficients are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Coefficients {
    /// With 53 bits: as they are.
    #[default]
    Double,
    /// With 24 bits.
    Single,
}

impl Quantization {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let bits = |name, doc| key(name, &RATIO, doc).not_negative().at_most(32.0).or(0.0);
        let k = bits("command_bits", "Bits of the command's converter; 0: it does not round.");
        v.count(k, &mut self.command_bits);
        v.pair(key("command_range", &VOLTAGE, "From and to."), &mut self.command_range);
        let k = bits("measurement_bits", "Bits of the measurement's converter; 0: it does not round.");
        v.count(k, &mut self.measurement_bits);
        v.pair(key("measurement_range", &FORCE, "From and to."), &mut self.measurement_range);
        let words = &[("f64", Coefficients::Double), ("f32", Coefficients::Single)];
        let k = plain("coefficients", "How the coefficients are kept.");
        v.choice(k, words, &mut self.coefficients, false);
    }
}

/// What happens to the integrator at the limit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AntiWindup {
    /// It winds up.
    #[default]
    None,
    /// It is fed back the excess.
    BackCalculation,
    /// It stops.
    Clamping,
}

/// How a continuous controller becomes a sampled one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Discretization {
    /// The bilinear rule.
    #[default]
    Tustin,
    /// Exact for piecewise constant input.
    ZeroOrderHold,
    /// Poles and zeros mapped by exp(sT).
    Matched,
}

impl Controller {
    /// Whether it says what it does, and not only when: without a law it is to be designed.
    pub fn has_law(&self) -> bool {
        self.transfer.form().is_some()
    }

    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        self.transfer.visit(v);
        let k = key("saturation", &VOLTAGE, "Limit of the command.").positive();
        v.optional(k, &mut self.saturation);
        let words = &[
            ("none", AntiWindup::None),
            ("back_calculation", AntiWindup::BackCalculation),
            ("clamping", AntiWindup::Clamping),
        ];
        let k = plain("anti_windup", "What happens to the integrator at the limit.");
        v.choice(k, words, &mut self.anti_windup, false);
        let k = key("sample_time", &TIME, "Sample time; absent: continuous.").positive();
        v.optional(k, &mut self.sample_time);
        let k = key("delay", &TIME, "Computation and transport delay of the loop, part of every verdict.");
        v.quantity(k.not_negative().or(0.0), &mut self.delay);
        let words = &[
            ("tustin", Discretization::Tustin),
            ("zero_order_hold", Discretization::ZeroOrderHold),
            ("matched", Discretization::Matched),
        ];
        let k = plain("discretization", "How a continuous controller becomes a sampled one.");
        v.choice(k, words, &mut self.discretization, false);
        let k = plain("quantization", "What the computer of a sampled controller rounds.");
        v.table(k, &mut self.quantization, Quantization::visit);
    }
}

/// The prefilter as declared.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Prefilter {
    /// From reference to filtered reference.
    pub transfer: Transfer,
    /// s; absent: continuous.
    pub sample_time: Option<f64>,
}

impl Prefilter {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        self.transfer.visit(v);
        let k = key("sample_time", &TIME, "Sample time; absent: continuous.").positive();
        v.optional(k, &mut self.sample_time);
    }
}
