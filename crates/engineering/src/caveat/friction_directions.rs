//! Caveat for a viscous friction that differs by direction, since the linear plant has one slope.

use super::{Caveat, UncountedEffect, is_measured};
use crate::project::Project;
use crate::setup::Setup;

/// Paths of the numbers that determine the viscous friction of the plants.
const OF_PLANT: [&str; 2] = ["viscous_friction", "cylinder.friction.viscous"];

/// Relative difference of a plant's viscous friction that is negligible.
const SAME: f64 = 1e-9;

/// Caveat for the viscous friction of a direction that is in no plant of the family.
pub(super) fn friction_directions(setup: &Setup<'_>) -> Option<Caveat> {
    if is_measured(setup.project) {
        return None;
    }
    let rig = setup.rig().ok()?;
    let [extending, retracting] = rig.actuator.components().friction.viscous_by_direction();
    let [low, high] = [extending.min(retracting), extending.max(retracting)];
    let own = rig.parameters.iter().find(|one| one.name == "viscous_friction")?.value;
    let [least, most] = range(setup.project).unwrap_or([own; 2]);
    let is_within = least <= low * (1.0 + SAME) && high <= most * (1.0 + SAME);
    if high - low <= SAME * high || is_within {
        return None;
    }
    Some(Caveat { effect: UncountedEffect::FrictionDirections { extending, retracting }, unproven: true })
}

/// Interval of the viscous friction that the project states.
fn range(project: &Project) -> Option<[f64; 2]> {
    let of = |path: &&str| project.uncertainty.iter().find(|one| one.name == **path);
    OF_PLANT.iter().find_map(of).map(|one| [one.minimum, one.maximum])
}
