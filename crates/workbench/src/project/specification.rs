//! `[[specification]]`: what the closed loop must meet.

use super::formula::Formula;
use super::key::{key, plain};
use super::plant::Rational;
use super::visitor::{Form, Shape, Visitor};
use crate::quantity::{ANGULAR_FREQUENCY, GAIN};

/// One specification.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Specification {
    /// Which closed loop is limited.
    pub kind: SpecificationKind,
    /// Upper limit; of every kind but tracking.
    pub limit: Option<Limit>,
    /// Upper limit of tracking.
    pub upper: Option<Limit>,
    /// Lower limit of tracking.
    pub lower: Option<Limit>,
    /// rad/s, where bounds are drawn.
    pub frequencies: Vec<f64>,
    /// rad/s, where it must hold; absent: the span of `frequencies`.
    pub band: Option<[f64; 2]>,
}

/// Which closed loop is limited.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SpecificationKind {
    /// |L/(1+L)|.
    #[default]
    RobustStability,
    /// |1/(1+L)|.
    Sensitivity,
    /// |P/(1+L)|.
    PlantInputDisturbance,
    /// |G/(1+L)|.
    ControlEffort,
    /// |P_d/(1+L)|.
    LoadMotion,
    /// lower <= |F L/(1+L)| <= upper.
    Tracking,
}

/// The words of `kind`.
pub static SPECIFICATION_KINDS: [(&str, SpecificationKind); 6] = [
    ("robust_stability", SpecificationKind::RobustStability),
    ("sensitivity", SpecificationKind::Sensitivity),
    ("plant_input_disturbance", SpecificationKind::PlantInputDisturbance),
    ("control_effort", SpecificationKind::ControlEffort),
    ("load_motion", SpecificationKind::LoadMotion),
    ("tracking", SpecificationKind::Tracking),
];

/// A limit over frequency.
#[derive(Clone, Debug, PartialEq)]
pub enum Limit {
    /// The same at every frequency.
    Constant(f64),
    /// The magnitude of a ratio of polynomials in one text.
    Text(Formula),
    /// The magnitude of a transfer function.
    Rational(Rational),
    /// Numbers at frequencies, between which it is log-log linear.
    Table(LimitTable),
}

/// A limit at frequencies.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LimitTable {
    /// rad/s, increasing.
    pub frequencies: Vec<f64>,
    /// Ratios, as many.
    pub values: Vec<f64>,
}

impl Specification {
    /// Where it must hold, rad/s: the declared band, or the span of the frequencies.
    pub fn band_rad_per_s(&self) -> [f64; 2] {
        let first = self.frequencies.first().copied().unwrap_or(0.0);
        let last = self.frequencies.last().copied().unwrap_or(0.0);
        self.band.unwrap_or([first, last])
    }

    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        v.choice(plain("kind", "Which closed loop is limited."), &SPECIFICATION_KINDS, &mut self.kind, true);
        Limit::visit("limit", "Upper limit, of every kind but tracking.", &mut self.limit, v);
        Limit::visit("upper", "Upper limit of tracking.", &mut self.upper, v);
        Limit::visit("lower", "Lower limit of tracking.", &mut self.lower, v);
        let k = key("frequencies", &ANGULAR_FREQUENCY, "Where bounds are drawn, increasing.").positive();
        v.quantities(k, &mut self.frequencies);
        let k = key("band", &ANGULAR_FREQUENCY, "Where it must hold; absent: the span of `frequencies`.");
        v.pair(k.not_negative().or_infinite(), &mut self.band);
    }
}

impl Limit {
    fn visit<V: Visitor>(name: &'static str, doc: &'static str, field: &mut Option<Limit>, v: &mut V) {
        let k = key(name, &GAIN, doc).positive();
        let form = match field {
            None | Some(Limit::Constant(_)) => Form::Number,
            Some(Limit::Text(_)) => Form::Text,
            Some(Limit::Rational(_) | Limit::Table(_)) => Form::Table,
        };
        match v.form(k, form) {
            Form::Number => {
                let mut number = if let Some(Limit::Constant(value)) = field { Some(*value) } else { None };
                v.optional(k, &mut number);
                *field = number.map(Limit::Constant);
            }
            Form::Text => {
                let mut formula = if let Some(Limit::Text(f)) = field.take() { Some(f) } else { None };
                v.formula(k, Shape::Ratio, &mut formula, false);
                *field = formula.map(Limit::Text);
            }
            Form::Table => v.table(k, field, Limit::visit_table),
        }
    }

    fn visit_table<V: Visitor>(&mut self, v: &mut V) {
        let mut table =
            if let Limit::Table(table) = self { std::mem::take(table) } else { LimitTable::default() };
        let k = key("frequencies", &ANGULAR_FREQUENCY, "Frequencies of a tabled limit, increasing.");
        v.quantities(k.positive(), &mut table.frequencies);
        if !table.frequencies.is_empty() {
            v.quantities(key("values", &GAIN, "The limit at each frequency.").positive(), &mut table.values);
            *self = Limit::Table(table);
            return;
        }
        let mut rational =
            if let Limit::Rational(r) = self { std::mem::take(r) } else { Rational::default() };
        rational.visit(v);
        *self = Limit::Rational(rational);
    }
}

impl Default for Limit {
    fn default() -> Self {
        Limit::Rational(Rational::default())
    }
}
