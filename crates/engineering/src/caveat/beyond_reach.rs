//! Required steps that the declared rig does not reach.

use super::{Caveat, UncountedEffect};
use crate::setup::Setup;
use crate::simulate::{steps_beyond, time_requirements};

/// Caveats for steps beyond the stall force or the capacity of the sensor: a linear loop follows a
/// step of any size, the rig does not.
pub(super) fn beyond_reach(setup: &Setup<'_>) -> Vec<Caveat> {
    let required = time_requirements(setup.project).unwrap_or_default();
    let beyond = steps_beyond(setup, &required).into_iter();
    beyond.map(|one| Caveat { effect: UncountedEffect::BeyondReach(one), unproven: true }).collect()
}
