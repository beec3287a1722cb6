//! Elements in series.

use std::collections::BTreeMap;

use super::DOMAINS;
use crate::catalogue::Catalogue;
use crate::project::formula::{Formula, Variable};
use crate::project::key::{key, plain};
use crate::project::printer::Printer;
use crate::project::reader::Reader;
use crate::project::text::Findings;
use crate::project::tree::{Entry, Node, Value};
use crate::project::validate;
use crate::project::visitor::{Shape, Visitor};
use crate::quantity::{ANGULAR_FREQUENCY, RATIO, TIME};

/// One element of a controller; every kind but gain, `pi`, `pid` and `general` has unit gain at zero frequency (integrator and
/// differentiator: at 1 rad/s).
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    /// Which element.
    pub kind: ElementKind,
    /// Whether it acts; one that does not is kept in the list all the same.
    pub enabled: bool,
    /// Of a gain.
    pub value: Option<f64>,
    /// rad/s: corner or natural frequency.
    pub frequency: Option<f64>,
    /// Of a complex pair, of a notch's denominator, or of a roll-off, where it may be absent: 1/√2.
    pub damping_ratio: Option<f64>,
    /// Of a notch's numerator.
    pub numerator_damping_ratio: Option<f64>,
    /// rad/s, corner of the numerator of a lead or lag.
    pub zero_frequency: Option<f64>,
    /// rad/s, corner of the denominator of a lead or lag.
    pub pole_frequency: Option<f64>,
    /// K_p of a `pi` or `pid`.
    pub proportional_gain: Option<f64>,
    /// K_i of a `pi` or `pid`, 1/s.
    pub integral_gain: Option<f64>,
    /// K_d of a `pid`, s.
    pub derivative_gain: Option<f64>,
    /// T_f of a `pid`, s.
    pub filter_time: Option<f64>,
    /// Of a `general` element: polynomial in `s`, or in `z` when it is sampled.
    pub numerator: Option<Formula>,
    /// Of a `general` element: polynomial in `s`, or in `z` when it is sampled.
    pub denominator: Option<Formula>,
    /// Of a `general` element in factors: the leading coefficient.
    pub gain: Option<f64>,
    /// Real and imaginary parts, 1/s.
    pub zeros: Vec<[f64; 2]>,
    /// Real and imaginary parts, 1/s.
    pub poles: Vec<[f64; 2]>,
    /// Whether gain, zeros and poles are in s (absent) or in z.
    pub domain: Option<Variable>,
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
    /// (1 + s/ω_z)/(1 + s/ω_p); lags where ω_z > ω_p.
    Lead,
    /// (1 + s/ω_z)/(1 + s/ω_p), ω_z > ω_p.
    Lag,
    /// (s² + 2ζ_z ωs + ω²)/(s² + 2ζ_p ωs + ω²).
    Notch,
    /// 1/(1 + 2ζs/ω + s²/ω²) at high frequency; ζ may be left out.
    RollOff,
    /// K_p + K_i/s.
    ProportionalIntegral,
    /// K_p + K_i/s + K_d s/(T_f s + 1).
    ProportionalIntegralDerivative,
    /// A ratio of polynomials, or factors.
    General,
}

/// As they are written.
const KINDS: &[(&str, ElementKind)] = &[
    ("gain", ElementKind::Gain),
    ("integrator", ElementKind::Integrator),
    ("differentiator", ElementKind::Differentiator),
    ("zero", ElementKind::Zero),
    ("pole", ElementKind::Pole),
    ("complex_zeros", ElementKind::ComplexZeros),
    ("complex_poles", ElementKind::ComplexPoles),
    ("lead", ElementKind::Lead),
    ("lag", ElementKind::Lag),
    ("notch", ElementKind::Notch),
    ("roll_off", ElementKind::RollOff),
    ("pi", ElementKind::ProportionalIntegral),
    ("pid", ElementKind::ProportionalIntegralDerivative),
    ("general", ElementKind::General),
];

impl ElementKind {
    /// As it is written in the project file.
    pub fn name(self) -> &'static str {
        KINDS.iter().find(|(_, kind)| *kind == self).map_or("", |(name, _)| name)
    }
}

impl Default for Element {
    fn default() -> Self {
        Element {
            kind: ElementKind::default(),
            enabled: true,
            value: None,
            frequency: None,
            damping_ratio: None,
            numerator_damping_ratio: None,
            zero_frequency: None,
            pole_frequency: None,
            proportional_gain: None,
            integral_gain: None,
            derivative_gain: None,
            filter_time: None,
            numerator: None,
            denominator: None,
            gain: None,
            zeros: vec![],
            poles: vec![],
            domain: None,
        }
    }
}

impl Element {
    /// Whether it is written in `z`.
    pub fn is_sampled(&self) -> bool {
        let formulas = [&self.numerator, &self.denominator];
        self.domain == Some(Variable::Z)
            || formulas.into_iter().flatten().any(|formula| formula.variable() == Some(Variable::Z))
    }

    /// As an inline table of the project file, which reads back as the same element.
    ///
    /// # Example
    /// ```
    /// use phea_workbench::project::{Element, ElementKind};
    /// let zero = Element { kind: ElementKind::Zero, frequency: Some(20.0), enabled: false, ..Element::default() };
    /// assert_eq!(zero.print(), r#"{ kind = "zero", enabled = false, frequency = "20 rad/s" }"#);
    /// ```
    pub fn print(&self) -> String {
        let mut printer = Printer::new(BTreeMap::new());
        self.clone().visit(&mut printer);
        printer.finish_inline().unwrap_or_default()
    }

    /// As the lines of a table of its own.
    pub(crate) fn print_lines(&self) -> String {
        let mut printer = Printer::new(BTreeMap::new());
        self.clone().visit(&mut printer);
        printer.finish()
    }

    /// The element that a table describes; what is wrong with it goes to the findings. `sample_time` in s is that of the controller.
    pub(crate) fn read(node: &Node, sample_time: Option<f64>, findings: &mut Findings) -> Option<Element> {
        let errors = findings.error_count();
        let place = node.place;
        let entry = Entry { key: "elements".to_string(), key_place: place, node: node.clone() };
        let root = Node { place, value: Value::Table(vec![entry]) };
        let catalogue = Catalogue::default();
        let mut reader = Reader::new(&root, place.text, &catalogue, findings);
        let mut element: Option<Element> = None;
        reader.table(plain("elements", "An element."), &mut element, Element::visit);
        if let Some(element) = &element {
            validate::element(element, "elements", sample_time, &mut reader);
        }
        element.filter(|_| findings.error_count() == errors)
    }

    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        v.choice(plain("kind", "Which element."), KINDS, &mut self.kind, true);
        v.switch(plain("enabled", "Whether it acts."), &mut self.enabled);
        v.optional(key("value", &RATIO, "Of a gain."), &mut self.value);
        let k = key("frequency", &ANGULAR_FREQUENCY, "Corner or natural frequency.");
        v.optional(k.positive(), &mut self.frequency);
        let k = key("damping_ratio", &RATIO, "Of a complex pair, a notch's denominator or a roll-off.");
        v.optional(k.not_negative(), &mut self.damping_ratio);
        let k = key("numerator_damping_ratio", &RATIO, "Of a notch's numerator.").not_negative();
        v.optional(k, &mut self.numerator_damping_ratio);
        let k = key("zero_frequency", &ANGULAR_FREQUENCY, "Corner of the numerator of a lead or lag.");
        v.optional(k.positive(), &mut self.zero_frequency);
        let k = key("pole_frequency", &ANGULAR_FREQUENCY, "Corner of the denominator of a lead or lag.");
        v.optional(k.positive(), &mut self.pole_frequency);
        let k = key("proportional_gain", &RATIO, "Of a PI or PID.");
        v.optional(k, &mut self.proportional_gain);
        let k = key("integral_gain", &RATIO, "Of a PI or PID, for each second.");
        v.optional(k, &mut self.integral_gain);
        let k = key("derivative_gain", &RATIO, "Of a PID, in seconds.");
        v.optional(k, &mut self.derivative_gain);
        let k = key("filter_time", &TIME, "Time constant of the derivative of a PID.").positive();
        v.optional(k, &mut self.filter_time);
        let k = plain("numerator", "Of a general element: polynomial in s, or in z when sampled.");
        v.formula(k, Shape::Polynomial, &mut self.numerator, false);
        let k = plain("denominator", "Of a general element: polynomial in s, or in z when sampled.");
        v.formula(k, Shape::Polynomial, &mut self.denominator, false);
        let k = key("gain", &RATIO, "Of a general element in factors: the leading coefficient.");
        v.optional(k, &mut self.gain);
        v.complexes(key("zeros", &RATIO, "Of a general element in factors."), &mut self.zeros);
        v.complexes(key("poles", &RATIO, "Of a general element in factors."), &mut self.poles);
        let k = plain("domain", "Of a general element in factors: in s, or in z when sampled.");
        v.choice(k, &DOMAINS, &mut self.domain, false);
    }
}
