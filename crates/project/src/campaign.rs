//! Table `[campaign]`: the variations of a Monte Carlo campaign.

use phea_quantity::RATIO;
use phea_table::Visitor;
use phea_table::{Key, key, plain};

/// Varied numbers and their distributions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Campaign {
    /// Varied numbers, in file order.
    pub parameters: Vec<Varied>,
    /// Default distribution of the parameters.
    pub distribution: Distribution,
    /// Name of the simulated scenario; if absent, the first.
    pub scenario: Option<String>,
    /// Number of runs in a report; if absent, a number sufficient for its quantiles.
    pub runs: Option<u32>,
}

/// Varied number: around its declared value, or between two values.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Varied {
    /// Path of the project, or `start.` and a state.
    pub path: String,
    /// Half-width of the range, as a fraction of the declared value.
    pub spread: Option<f64>,
    /// Lower end, SI.
    pub minimum: Option<f64>,
    /// Upper end, SI.
    pub maximum: Option<f64>,
    /// Distribution; if absent, that of the campaign.
    pub distribution: Option<Distribution>,
}

/// Distribution of a varied number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Distribution {
    /// Uniform between its ends.
    #[default]
    Uniform,
    /// Normal; its ends are two standard deviations from the middle.
    Normal,
    /// Uniform in the logarithm.
    LogUniform,
    /// Triangular, highest in the middle.
    Triangular,
}

/// Words of the distributions.
pub static DISTRIBUTIONS: [(&str, Distribution); 4] = [
    ("uniform", Distribution::Uniform),
    ("normal", Distribution::Normal),
    ("log_uniform", Distribution::LogUniform),
    ("triangular", Distribution::Triangular),
];

static VARIED: [(&str, Option<Distribution>); 4] = [
    ("uniform", Some(Distribution::Uniform)),
    ("normal", Some(Distribution::Normal)),
    ("log_uniform", Some(Distribution::LogUniform)),
    ("triangular", Some(Distribution::Triangular)),
];

impl Campaign {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = plain("distribution", "Default distribution of the parameters.");
        v.choice(k, &DISTRIBUTIONS, &mut self.distribution, false);
        v.text(plain("scenario", "Which scenario is driven; absent, the first."), &mut self.scenario, false);
        let k = key("runs", &RATIO, "How many runs a report makes; absent: 200.").at_least(1.0);
        v.optional_count(k, &mut self.runs);
        let k = plain("parameters", "What is varied, by its path.");
        v.dictionary(
            k,
            |varied| &varied.path,
            &mut self.parameters,
            |varied: &mut Varied, number, v| {
                varied.path = number.name.to_string();
                varied.visit(number.key, v);
            },
        );
    }
}

impl Varied {
    fn visit<V: Visitor>(&mut self, number: Key, v: &mut V) {
        let k =
            key("spread", &RATIO, "Half-width of the range, as a share of the declared value.").positive();
        v.optional(k, &mut self.spread);
        let part = |name, doc| Key { name, doc, default: None, ..number };
        v.optional(part("minimum", "The least it takes."), &mut self.minimum);
        v.optional(part("maximum", "The most it takes."), &mut self.maximum);
        v.choice(plain("distribution", "How it is distributed."), &VARIED, &mut self.distribution, false);
    }
}
