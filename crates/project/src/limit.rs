//! Keys `limit`, `upper` and `lower` of a specification, in each of their forms.

use super::plant::Rational;
use phea_dynamics::time_response::SettlingRule;
use phea_quantity::{ANGLE, ANGULAR_FREQUENCY, GAIN, PERCENT, RATIO, TIME};
use phea_table::Formula;
use phea_table::{FormulaShape, ValueForm, Visitor};
use phea_table::{Key, key, plain};

/// Limit over frequency.
#[derive(Clone, Debug, PartialEq)]
pub enum DeclaredLimit {
    /// Constant over frequency.
    Constant(f64),
    /// Magnitude of a ratio of polynomials in one text.
    Text(Formula),
    /// Magnitude of a transfer function.
    Rational(Rational),
    /// Numbers at frequencies, interpolated linearly in a log-log diagram.
    Table(DeclaredLimitTable),
    /// Limit that guarantees these margins.
    Margins(MarginRequirement),
    /// Limit that follows from a requirement in time, or is checked against one.
    Response(ResponseRequirement),
}

/// Limit at frequencies.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredLimitTable {
    /// Frequencies, increasing, rad/s.
    pub frequencies: Vec<f64>,
    /// Ratios, one for each frequency.
    pub values: Vec<f64>,
}

/// Margins that a limit must guarantee; the strictest one determines the limit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MarginRequirement {
    /// Factor by which the gain may grow, above 1.
    pub gain_margin: Option<f64>,
    /// Factor to which the gain may fall, below 1.
    pub gain_reduction: Option<f64>,
    /// Phase margin, rad.
    pub phase_margin: Option<f64>,
    /// Least distance |1 + L|.
    pub modulus_margin: Option<f64>,
    /// Delay margin, s.
    pub delay_margin: Option<f64>,
}

/// Required step response: the fastest one for `upper`, the slowest for `lower`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ResponseRequirement {
    /// Overshoot, percent of the step; for `upper`.
    pub overshoot_percent: Option<f64>,
    /// Settling time, s.
    pub settling_time: Option<f64>,
    /// Settling band, percent of the step.
    pub settling_band_percent: Option<f64>,
    /// Zero added to `upper`, rad/s.
    pub zero: Option<f64>,
    /// Pole added to `lower`, rad/s.
    pub pole: Option<f64>,
    /// Rule that converts the requirement into a second-order model; if absent, the model is such
    /// that the response, including an extra zero or pole, satisfies the requirement.
    pub rule: Option<SettlingRule>,
    /// Limit that is given and only checked against the requirement.
    pub function: Option<Rational>,
}

impl DeclaredLimit {
    pub(super) fn visit<V: Visitor>(
        name: &'static str,
        doc: &'static str,
        field: &mut Option<DeclaredLimit>,
        v: &mut V,
    ) {
        let k = key(name, &GAIN, doc).positive();
        let form = match field {
            None | Some(DeclaredLimit::Constant(_)) => ValueForm::Number,
            Some(DeclaredLimit::Text(_)) => ValueForm::Text,
            Some(_) => ValueForm::Table,
        };
        match v.form(k, form) {
            ValueForm::Number => {
                let mut number =
                    if let Some(DeclaredLimit::Constant(value)) = field { Some(*value) } else { None };
                v.optional(k, &mut number);
                *field = number.map(DeclaredLimit::Constant);
            }
            ValueForm::Text => {
                let mut formula =
                    if let Some(DeclaredLimit::Text(f)) = field.take() { Some(f) } else { None };
                v.formula(k, FormulaShape::Ratio, &mut formula, false);
                *field = formula.map(DeclaredLimit::Text);
            }
            ValueForm::Table => v.table(k, field, DeclaredLimit::visit_table),
        }
    }

    /// Reads every key, so that the nearest spelling of a misspelt one is found; the keys that are
    /// present determine the form. No key at all counts as an empty table.
    fn visit_table<V: Visitor>(&mut self, v: &mut V) {
        let (mut table, mut function) = (DeclaredLimitTable::default(), None);
        let (mut margins, mut response) = (MarginRequirement::default(), ResponseRequirement::default());
        match std::mem::take(self) {
            DeclaredLimit::Table(of) => table = of,
            DeclaredLimit::Rational(of) => function = Some(of),
            DeclaredLimit::Margins(of) => margins = of,
            DeclaredLimit::Response(of) => {
                response = of;
                function = response.function.take();
            }
            DeclaredLimit::Constant(_) | DeclaredLimit::Text(_) => {}
        }
        let (mut numerator, mut denominator) = function.map(|of| (of.numerator, of.denominator)).unzip();
        let k = key("frequencies", &ANGULAR_FREQUENCY, "Frequencies of a tabled limit, increasing.");
        v.quantities(k.positive(), &mut table.frequencies, false);
        let k = key("values", &GAIN, "The limit at each frequency.").positive();
        v.quantities(k, &mut table.values, false);
        let k = plain("numerator", "Polynomial, such as \"2116*(s + 75)/75\".");
        v.formula(k, FormulaShape::Polynomial, &mut numerator, false);
        let k = plain("denominator", "Polynomial, such as \"s^2 + 73.6*s + 2116\".");
        v.formula(k, FormulaShape::Polynomial, &mut denominator, numerator.is_some());
        margins.visit(v);
        response.visit(v);
        let function = numerator.zip(denominator);
        let function =
            function.map(|(numerator, denominator)| Rational { numerator, denominator, factors: None });
        *self = match function {
            _ if !table.frequencies.is_empty() => DeclaredLimit::Table(table),
            _ if margins != MarginRequirement::default() => DeclaredLimit::Margins(margins),
            function if response != ResponseRequirement::default() => {
                DeclaredLimit::Response(ResponseRequirement { function, ..response })
            }
            Some(function) => DeclaredLimit::Rational(function),
            None => DeclaredLimit::Table(table),
        };
    }
}

impl MarginRequirement {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let gain = |name, doc| key(name, &GAIN, doc);
        let k = gain("gain_margin", "Factor by which the gain may grow, such as \"6 dB\".").above(1.0);
        v.optional(k, &mut self.gain_margin);
        let k = gain("gain_reduction", "Factor to which the gain may fall, such as \"-6 dB\".");
        v.optional(k.positive().below(1.0), &mut self.gain_reduction);
        let k = key("phase_margin", &ANGLE, "Phase margin, such as \"50 deg\".").positive();
        v.optional(k.at_most(std::f64::consts::PI), &mut self.phase_margin);
        let k = key("modulus_margin", &RATIO, "Least distance of L from -1.").positive().below(1.0);
        v.optional(k, &mut self.modulus_margin);
        let k = key("delay_margin", &TIME, "Delay that the loop tolerates beyond its own.").positive();
        v.optional(k, &mut self.delay_margin);
    }
}

impl ResponseRequirement {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let percent = |name, doc| -> Key { key(name, &PERCENT, doc).below(100.0) };
        let k = percent("overshoot_percent", "Largest overshoot, in percent of the step; of `upper`.");
        v.optional(k.not_negative(), &mut self.overshoot_percent);
        let k = key("settling_time", &TIME, "Settling time, with `settling_band_percent`.").positive();
        v.optional(k, &mut self.settling_time);
        let k = percent("settling_band_percent", "Band of the settling time, in percent of the step.");
        v.optional(k.positive(), &mut self.settling_band_percent);
        let k = key("zero", &ANGULAR_FREQUENCY, "The zero added to `upper`.").positive();
        v.optional(k, &mut self.zero);
        let k = key("pole", &ANGULAR_FREQUENCY, "The pole added to `lower`.").positive();
        v.optional(k, &mut self.pole);
        if v.names_everything() || *self != ResponseRequirement::default() {
            let words = &[
                ("exact", None),
                ("five_percent", Some(SettlingRule::FivePercent)),
                ("two_percent", Some(SettlingRule::TwoPercent)),
                ("one_percent", Some(SettlingRule::OnePercent)),
                ("one_percent_thesis", Some(SettlingRule::OnePercentThesis)),
                ("critically_damped_two_percent", Some(SettlingRule::CriticallyDampedTwoPercent)),
            ];
            v.choice(
                plain("rule", "How the requirement becomes a transfer function."),
                words,
                &mut self.rule,
                false,
            );
        }
    }
}

impl Default for DeclaredLimit {
    fn default() -> Self {
        DeclaredLimit::Table(DeclaredLimitTable::default())
    }
}
