//! `[campaign]`: what is varied in a Monte Carlo campaign.

use super::key::{Key, key, plain};
use super::visitor::Visitor;
use phea_quantity::RATIO;

/// What is varied, and how it is distributed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Campaign {
    /// What is varied, in file order.
    pub parameters: Vec<Varied>,
    /// The distribution of parameters that do not state one.
    pub distribution: Distribution,
    /// Name of the scenario that is driven; absent: the first.
    pub scenario: Option<String>,
    /// Number of runs in a report; absent: a number that suffices for its quantiles.
    pub runs: Option<u32>,
}

/// One varied number: around its declared value, or between two.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Varied {
    /// A path of the project, or `start.` and a state.
    pub path: String,
    /// Half-width of the range, as a share of the declared value.
    pub spread: Option<f64>,
    /// In SI.
    pub minimum: Option<f64>,
    /// In SI.
    pub maximum: Option<f64>,
    /// Absent: the campaign's.
    pub distribution: Option<Distribution>,
}

/// How a varied number is distributed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Distribution {
    /// Evenly between its ends.
    #[default]
    Uniform,
    /// Normal; its ends are two standard deviations from the middle.
    Normal,
    /// Evenly in the logarithm.
    LogUniform,
    /// Triangular, highest in the middle.
    Triangular,
}

/// The words of a distribution.
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
