//! Required steps that no controller makes on the rig, each with the key that states it and a
//! sufficient change.

mod in_time;
mod on_rig;

use phea_qft::family::{Extent, Family, UncertainFamily, vertices};

pub use in_time::StillTimes;
pub use on_rig::SlowStep;

use crate::quantity::Units;
use crate::robust::RobustProblem;
use crate::setup::Setup;
use crate::simulate::BeyondReach;

/// Largest number of examined corners of a box, and of members.
const CORNERS: usize = 8;
const MEMBERS: usize = 8;
/// Largest number of coordinates of a box whose corners are listed.
const COORDINATES_MAXIMUM: usize = 8;

/// A required step that no controller makes on the rig.
#[derive(Clone, Debug, PartialEq)]
pub enum ImpossibleStep {
    /// The step must settle before the force can move.
    BeforeForceMoves {
        /// Number of the specification, from 1.
        number: usize,
        /// Key of the settling time in the specification.
        key: &'static str,
        /// Required settling time, s.
        settling: f64,
        /// Delays before the force moves.
        still: StillTimes,
    },
    /// The step is beyond the piston or the force sensor.
    BeyondReach(BeyondReach),
    /// The step is beyond the valve.
    TooSlow(SlowStep),
}

impl ImpossibleStep {
    /// Path of the key that states the step.
    pub fn path(&self) -> String {
        let (number, key) = match self {
            ImpossibleStep::BeforeForceMoves { number, key, .. } => (number, *key),
            ImpossibleStep::BeyondReach(beyond) => (&beyond.number, beyond.end.key()),
            ImpossibleStep::TooSlow(slow) => (&slow.number, "settling_time"),
        };
        format!("specification[{}].{key}", number - 1)
    }
}

/// Required steps that no controller makes on the rig, with the units of its project.
#[derive(Clone, Debug, PartialEq)]
pub struct ImpossibleSteps {
    /// Required steps.
    pub steps: Vec<ImpossibleStep>,
    /// Motion of the rig and units of display.
    pub units: Units,
}

/// Steps that the project requires and that no controller makes on its rig: shorter than a delay,
/// or beyond the capability of valve, piston or force sensor. They are found before any search.
pub(crate) fn impossible_steps(setup: &Setup<'_>, problem: &RobustProblem) -> Vec<ImpossibleStep> {
    let few = few_plants(&problem.family);
    [in_time::findings(setup, problem), on_rig::findings(setup, problem, &few)].concat()
}

/// Nominal plant, some corners and some members: anything impossible for these is impossible for
/// the family.
pub(crate) fn few_plants(family: &Family) -> Family {
    let Family::Uncertain(uncertain) = family else { return family.clone() };
    let strided = |plants: &[Vec<f64>], most: usize| -> Vec<Vec<f64>> {
        plants.iter().step_by(plants.len().div_ceil(most).max(1)).chain(plants.last()).cloned().collect()
    };
    let dimension = uncertain.coordinates().len();
    let corners = match uncertain.extent() == Extent::Box && (1..=COORDINATES_MAXIMUM).contains(&dimension) {
        true => vertices(uncertain.plant(), uncertain.coordinates()).unwrap_or_default(),
        false => vec![],
    };
    let members = [strided(&corners, CORNERS), strided(uncertain.members(), MEMBERS)].concat();
    let plant = uncertain.plant().clone();
    let few = UncertainFamily::new(plant, vec![], members, Extent::Members);
    few.map_or_else(|_| family.clone(), Family::Uncertain)
}
