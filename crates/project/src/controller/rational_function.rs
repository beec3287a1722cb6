//! Ratio of polynomials, as polynomials or by its factors.

use phea_quantity::RATIO;
use phea_table::{Formula, Variable};
use phea_table::{FormulaShape, Visitor};
use phea_table::{key, plain};

/// Ratio of polynomials in s or z: numerator and denominator, or gain, zeros and poles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RationalFunction {
    /// Polynomial in `s`, or in `z` if it is sampled.
    pub numerator: Option<Formula>,
    /// Polynomial in `s`, or in `z` if it is sampled.
    pub denominator: Option<Formula>,
    /// Leading coefficient k of k Π(s - z)/Π(s - p).
    pub gain: Option<f64>,
    /// Real and imaginary parts, 1/s.
    pub zeros: Vec<[f64; 2]>,
    /// Real and imaginary parts, 1/s.
    pub poles: Vec<[f64; 2]>,
    /// Variable of gain, zeros and poles: s if absent, or z.
    pub domain: Option<Variable>,
}

/// Words of `domain`.
static DOMAINS: [(&str, Option<Variable>); 2] = [("s", Some(Variable::S)), ("z", Some(Variable::Z))];

impl RationalFunction {
    /// True if it is stated in either form.
    pub(crate) fn is_stated(&self) -> bool {
        (self.numerator.is_some() && self.denominator.is_some()) || self.gain.is_some()
    }

    /// True if it is written in `z`.
    pub fn is_sampled(&self) -> bool {
        let formulas = [&self.numerator, &self.denominator];
        self.domain == Some(Variable::Z)
            || formulas.into_iter().flatten().any(|formula| formula.variable() == Some(Variable::Z))
    }

    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = plain("numerator", "Polynomial in s, or in z when sampled.");
        v.formula(k, FormulaShape::Polynomial, &mut self.numerator, false);
        let k = plain("denominator", "Polynomial in s, or in z when sampled.");
        v.formula(k, FormulaShape::Polynomial, &mut self.denominator, false);
        let k = key("gain", &RATIO, "Leading coefficient: k of k prod(s - z)/prod(s - p).");
        v.optional(k, &mut self.gain);
        let k = key("zeros", &RATIO, "Numbers, or [re, im] pairs with their conjugates.");
        v.complexes(k, &mut self.zeros);
        let k = key("poles", &RATIO, "Numbers, or [re, im] pairs with their conjugates.");
        v.complexes(k, &mut self.poles);
        let k = plain("domain", "Of gain, zeros and poles: in s, or in z when sampled.");
        v.choice(k, &DOMAINS, &mut self.domain, false);
    }
}
