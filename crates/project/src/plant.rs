//! Table `[plant]`: a plant given as a transfer function instead of an actuator.

use phea_quantity::{RATIO, TIME};
use phea_table::Formula;
use phea_table::{FormulaShape, ValueForm, Visitor};
use phea_table::{Key, key, plain};

/// Transfer function in `s` and named parameters.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredPlant {
    /// Numerator and denominator.
    pub transfer: Rational,
    /// Dead time.
    pub delay: Delay,
    /// Second path, for "load_motion".
    pub disturbance: Option<Rational>,
}

/// Dead time of a plant.
#[derive(Clone, Debug, PartialEq)]
pub enum Delay {
    /// Constant dead time, s.
    Constant(f64),
    /// Formula of the uncertain parameters that gives seconds.
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

/// Numerator and denominator: as written, or those of the written factors.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rational {
    /// Polynomial of the numerator.
    pub numerator: Formula,
    /// Polynomial of the denominator.
    pub denominator: Formula,
    /// Factors of which they are the products, if these are written.
    pub factors: Option<PlantFactors>,
}

/// Factored form k Π(s - z)/Π(s - p).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlantFactors {
    /// Gain k: a number, or a formula of the uncertain parameters.
    pub gain: Option<Formula>,
    /// Real and imaginary parts, 1/s.
    pub zeros: Vec<[f64; 2]>,
    /// Real and imaginary parts, 1/s.
    pub poles: Vec<[f64; 2]>,
}

/// Keys of factors, and of polynomials.
const FACTORS: [&str; 3] = ["gain", "zeros", "poles"];
const POLYNOMIALS: [&str; 2] = ["numerator", "denominator"];

impl PlantFactors {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let doc =
            "Leading coefficient k of k prod(s - z)/prod(s - p), or a formula of the uncertain parameters.";
        v.formula(plain("gain", doc), FormulaShape::Coefficient, &mut self.gain, true);
        let k = key("zeros", &RATIO, "Numbers, or [re, im] pairs with their conjugates; absent: none.");
        v.complexes(k, &mut self.zeros);
        let k = key("poles", &RATIO, "Numbers, or [re, im] pairs with their conjugates; absent: none.");
        v.complexes(k, &mut self.poles);
    }

    /// Numerator and denominator; a pair counts by its root above the real axis.
    fn polynomials(&self) -> Option<[Formula; 2]> {
        let factor = |[real, imaginary]: &[f64; 2]| match imaginary {
            0.0 => format!("(s - ({real:e}))"),
            _ => format!("(s^2 - ({:e})*s + {:e})", 2.0 * real, real * real + imaginary * imaginary),
        };
        let product = |first: String, roots: &[[f64; 2]]| {
            let factors = roots.iter().filter(|[_, imaginary]| *imaginary >= 0.0).map(factor);
            Formula::parse_continuous(&std::iter::once(first).chain(factors).collect::<Vec<_>>().join("*"))
        };
        let gain = self.gain.as_ref()?.text();
        let is_sum = gain.parse::<f64>().is_err() && gain.contains(['+', '-', '/']);
        let gain = if is_sum { format!("({gain})") } else { gain.to_string() };
        product(gain, &self.zeros).and_then(|over| Ok([over, product("1".to_string(), &self.poles)?])).ok()
    }
}

impl Rational {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        self.visit_as(FormulaShape::Polynomial, v);
    }

    /// Visits polynomials with named parameters, or factors.
    fn visit_parametric<V: Visitor>(&mut self, v: &mut V) {
        let mut polynomials = self.factors.is_none().then(|| std::mem::take(self));
        v.way(&FACTORS, &mut self.factors, PlantFactors::visit);
        v.way(&POLYNOMIALS, &mut polynomials, |rational, v| rational.visit_as(FormulaShape::Parametric, v));
        v.one_of(&["numerator", "gain"], false);
        if polynomials.is_none() && self.factors.is_none() {
            let what = "`numerator` and `denominator`, or `gain` with `zeros` and `poles`,";
            v.lacks(&[&POLYNOMIALS, &["gain"]], what);
        }
        match (&self.factors, polynomials) {
            (Some(factors), _) => {
                if let Some([numerator, denominator]) = factors.polynomials() {
                    (self.numerator, self.denominator) = (numerator, denominator);
                }
            }
            (None, Some(polynomials)) => *self = polynomials,
            (None, None) => {}
        }
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
    /// All formulas with their paths; a gain represents the numerator of its factors.
    pub(crate) fn formulas(&self) -> Vec<(&'static str, &Formula)> {
        let mut formulas = Vec::new();
        let plant = ["plant.gain", "plant.numerator", "plant.denominator"];
        let second =
            ["plant.disturbance.gain", "plant.disturbance.numerator", "plant.disturbance.denominator"];
        let both = [(Some(&self.transfer), plant), (self.disturbance.as_ref(), second)];
        for (rational, [gain, numerator, denominator]) in both {
            let Some(rational) = rational else { continue };
            let numerator = if rational.factors.is_some() { gain } else { numerator };
            formulas.push((numerator, &rational.numerator));
            formulas.push((denominator, &rational.denominator));
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
