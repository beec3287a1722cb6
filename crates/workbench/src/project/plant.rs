//! `[plant]` and `[family]`: a plant given as a transfer function instead of an actuator.

use super::formula::Formula;
use super::key::{Key, key, plain};
use super::visitor::{Shape, Visitor};
use crate::quantity::{RATIO, TIME};

/// A transfer function in `s` and named parameters.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plant {
    /// Numerator and denominator.
    pub transfer: Rational,
    /// s, dead time.
    pub delay: f64,
    /// The second path, for "load_motion".
    pub disturbance: Option<Rational>,
}

/// Numerator and denominator as written.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rational {
    /// A polynomial.
    pub numerator: Formula,
    /// A polynomial.
    pub denominator: Formula,
}

impl Rational {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        self.visit_as(Shape::Polynomial, v);
    }

    fn visit_parametric<V: Visitor>(&mut self, v: &mut V) {
        self.visit_as(Shape::Parametric, v);
    }

    fn visit_as<V: Visitor>(&mut self, shape: Shape, v: &mut V) {
        let k = plain("numerator", "Polynomial, such as \"2116*(s + 75)/75\".");
        required(k, shape, &mut self.numerator, v);
        let k = plain("denominator", "Polynomial, such as \"s^2 + 73.6*s + 2116\".");
        required(k, shape, &mut self.denominator, v);
    }
}

fn required<V: Visitor>(key: Key, shape: Shape, field: &mut Formula, v: &mut V) {
    let mut formula = Some(std::mem::take(field));
    v.formula(key, shape, &mut formula, true);
    *field = formula.unwrap_or_default();
}

impl Plant {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        self.transfer.visit_parametric(v);
        v.quantity(key("delay", &TIME, "Dead time.").not_negative().or(0.0), &mut self.delay);
        let k = plain("disturbance", "Transfer function of the second path, for \"load_motion\".");
        v.table(k, &mut self.disturbance, Rational::visit_parametric);
    }
}

/// A family of plants that is not a grid.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Family {
    /// Plants by their parameters: name and value, in file order.
    pub cases: Vec<Case>,
    /// Groups of parameters that run through their ranges together.
    pub correlation: Vec<Correlation>,
    /// Files with measured frequency responses.
    pub measured: Vec<String>,
}

/// Parameters that run through their ranges together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Correlation {
    /// Names of uncertain parameters.
    pub parameters: Vec<String>,
}

/// One plant of an explicit family.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Case {
    /// Name and value in SI.
    pub parameters: Vec<(String, f64)>,
}

impl Family {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        v.tables(plain("cases", "Plants by their parameters."), &mut self.cases, Case::visit);
        let k = plain("correlation", "Groups of parameters that run through their ranges together.");
        v.tables(k, &mut self.correlation, Correlation::visit);
        let k = plain("measured", "Files with measured frequency responses.");
        v.texts(k, &mut self.measured);
    }
}

impl Correlation {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        v.texts(plain("parameters", "Names of uncertain parameters."), &mut self.parameters);
    }
}

impl Case {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        v.numbers(key("parameter", &RATIO, "Value of an uncertain parameter."), &mut self.parameters);
    }
}
