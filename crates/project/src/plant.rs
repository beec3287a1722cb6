//! `[plant]`: a plant given as a transfer function instead of an actuator.

use super::formula::Formula;
use super::key::{Key, key, plain};
use super::visitor::{FormulaShape, ValueForm, Visitor};
use phea_quantity::TIME;

/// A transfer function in `s` and named parameters.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredPlant {
    /// Numerator and denominator.
    pub transfer: Rational,
    /// Dead time.
    pub delay: Delay,
    /// The second path, for "load_motion".
    pub disturbance: Option<Rational>,
}

/// A dead time.
#[derive(Clone, Debug, PartialEq)]
pub enum Delay {
    /// s.
    Constant(f64),
    /// A formula of the uncertain parameters that gives seconds.
    Formula(Formula),
}

impl Default for Delay {
    fn default() -> Self {
        Delay::Constant(0.0)
    }
}

impl Delay {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let doc = "Dead time, or a formula of the uncertain parameters that gives seconds.";
        let k = key("delay", &TIME, doc).not_negative().or(0.0);
        let form = if let Delay::Formula(_) = self { ValueForm::Text } else { ValueForm::Number };
        if v.form(k, form) == ValueForm::Text {
            let mut formula =
                if let Delay::Formula(formula) = self { Some(std::mem::take(formula)) } else { None };
            v.formula(k, FormulaShape::Coefficient, &mut formula, false);
            *self = formula.map_or_else(Delay::default, Delay::Formula);
        } else {
            let mut seconds = if let Delay::Constant(seconds) = self { *seconds } else { 0.0 };
            v.quantity(k, &mut seconds);
            *self = Delay::Constant(seconds);
        }
    }
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
        self.visit_as(FormulaShape::Polynomial, v);
    }

    fn visit_parametric<V: Visitor>(&mut self, v: &mut V) {
        self.visit_as(FormulaShape::Parametric, v);
    }

    fn visit_as<V: Visitor>(&mut self, shape: FormulaShape, v: &mut V) {
        let k = plain("numerator", "Polynomial, such as \"2116*(s + 75)/75\".");
        required(k, shape, &mut self.numerator, v);
        let k = plain("denominator", "Polynomial, such as \"s^2 + 73.6*s + 2116\".");
        required(k, shape, &mut self.denominator, v);
    }
}

fn required<V: Visitor>(key: Key, shape: FormulaShape, field: &mut Formula, v: &mut V) {
    let mut formula = Some(std::mem::take(field));
    v.formula(key, shape, &mut formula, true);
    *field = formula.unwrap_or_default();
}

/// Path of the dead time.
pub(crate) const DELAY_PATH: &str = "plant.delay";

impl DeclaredPlant {
    /// Every formula with its path.
    pub(crate) fn formulas(&self) -> Vec<(&'static str, &Formula)> {
        let mut formulas = vec![("plant.numerator", &self.transfer.numerator)];
        formulas.push(("plant.denominator", &self.transfer.denominator));
        if let Some(second) = &self.disturbance {
            formulas.push(("plant.disturbance.numerator", &second.numerator));
            formulas.push(("plant.disturbance.denominator", &second.denominator));
        }
        if let Delay::Formula(formula) = &self.delay {
            formulas.push((DELAY_PATH, formula));
        }
        formulas
    }

    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        self.transfer.visit_parametric(v);
        self.delay.visit(v);
        let k = plain("disturbance", "Transfer function of the second path, for \"load_motion\".");
        v.table(k, &mut self.disturbance, Rational::visit_parametric);
    }
}
