//! Caveat for a spool at null whose edges differ on both sides.

use super::UncountedEffect;
use crate::setup::Setup;

/// Flow gains of both sides, and the one in the models of one plant.
pub(super) fn null_sides(setup: &Setup<'_>) -> Option<UncountedEffect> {
    if setup.project.operating_point.spool_side.is_some() {
        return None;
    }
    let rig = setup.rig().ok()?;
    let flow_gains = rig.null_flow_gains()?;
    Some(UncountedEffect::NullSides { flow_gains, mean: rig.derived.flow_gain })
}
