//! Table `[[uncertainty_direction]]`: numbers that are uncertain together.

use super::Uncertain;
use phea_dynamics::uncertain_plant::Spacing;
use phea_quantity::RATIO;
use phea_table::Visitor;
use phea_table::{AcceptedRange, Key, key, plain};

/// Variable z of a direction.
pub const DIRECTION: Key = key("direction", &RATIO, "Standard deviations along a direction.");

/// Numbers that move together by a standard normal variable z, independent of the other directions.
///
/// ```text
/// number = stated value + sum over directions of change z        |z| <= deviations
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct UncertaintyDirection {
    /// Name in the members of the family.
    pub name: String,
    /// Standard deviations to either side that are included in the family.
    pub deviations: f64,
    /// Points of the grid over it.
    pub points: u32,
    /// Numbers by their paths, and the change of each per standard deviation, SI.
    pub changes: NumberChanges,
}

/// Change of each number per standard deviation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NumberChanges {
    /// Path and change, SI.
    pub numbers: Vec<(String, f64)>,
}

impl UncertaintyDirection {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let mut name = Some(std::mem::take(&mut self.name));
        v.text(plain("name", "What members of the family call it."), &mut name, true);
        self.name = name.unwrap_or_default();
        let doc = "Standard deviations to either side that belong to the family.";
        v.quantity(key("deviations", &RATIO, doc).positive().at_most(10.0).or(1.96), &mut self.deviations);
        let k = key("points", &RATIO, "Points of the grid over it.").at_least(2.0).at_most(1000.0).or(2.0);
        v.count(k, &mut self.points);
        let k = plain("changes", "Change of each number per standard deviation, by its path.");
        v.needed_table(k, &mut self.changes, NumberChanges::visit);
    }

    /// Direction as an uncertain number z.
    pub(crate) fn as_uncertain(&self) -> Uncertain {
        Uncertain {
            name: self.name.clone(),
            nominal: 0.0,
            minimum: -self.deviations,
            maximum: self.deviations,
            points: self.points,
            spacing: Spacing::Linear,
        }
    }
}

impl NumberChanges {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        // a change has either sign, whatever the sign of the number
        let change = |number: Key| Key { range: AcceptedRange::ANY, default: None, ..number };
        v.numbers(key("number", &RATIO, "Change per standard deviation."), change, &mut self.numbers);
    }
}
