//! Table `[uncertainty]`: the uncertain numbers, and the grid over them.

use phea_dynamics::uncertain_plant::Spacing;
use phea_quantity::RATIO;
use phea_table::Visitor;
use phea_table::{Key, key, plain};

/// Uncertain number.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Uncertain {
    /// Name of a parameter of the linear model, a path of the project, or a parameter of `[plant]`.
    pub name: String,
    /// Nominal value, SI like the other two.
    pub nominal: f64,
    /// Least possible value.
    pub minimum: f64,
    /// Greatest possible value.
    pub maximum: f64,
    /// Points of the grid over it.
    pub points: u32,
    /// Spacing of the points.
    pub spacing: Spacing,
}

impl Uncertain {
    /// Visits a table of them, each by the name of its number.
    pub(crate) fn visit_all<V: Visitor>(k: Key, all: &mut Vec<Uncertain>, v: &mut V) {
        v.dictionary(
            k,
            |uncertain| &uncertain.name,
            all,
            |uncertain: &mut Uncertain, number, v| {
                uncertain.name = number.name.to_string();
                uncertain.visit(number.key, v);
            },
        );
    }

    /// Visits one; `number` has name, dimension and range of the number itself.
    fn visit<V: Visitor>(&mut self, number: Key, v: &mut V) {
        let part = |name, doc| Key { name, doc, default: None, ..number };
        v.quantity(part("nominal", "The value of plant 0."), &mut self.nominal);
        v.quantity(part("minimum", "The least it may be."), &mut self.minimum);
        v.quantity(part("maximum", "The most it may be."), &mut self.maximum);
        let k = key("points", &RATIO, "Points of the grid over it.").at_least(1.0).at_most(1000.0).or(3.0);
        v.count(k, &mut self.points);
        let words = &[("linear", Spacing::Linear), ("log", Spacing::Logarithmic)];
        v.choice(plain("spacing", "How the points are spread."), words, &mut self.spacing, false);
    }
}
