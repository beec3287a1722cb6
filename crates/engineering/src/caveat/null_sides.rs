//! A spool at null whose edges differ on both sides.

use crate::quantity::significant;
use crate::setup::Setup;

/// Which flow gain the models of one plant have.
pub(super) fn null_sides(setup: &Setup<'_>) -> Option<String> {
    if setup.project.operating_point.spool_side.is_some() {
        return None;
    }
    let rig = setup.rig().ok()?;
    let [below, above] = rig.null_flow_gains()?.map(|gain| significant(gain, 3));
    let mean = significant(rig.derived.flow_gain, 3);
    Some(format!(
        "at null K_qU is {below} m3/(s.V) where the piston retracts and {above} where it extends: these models have the mean, {mean}, \
         unless it is stated; verify and design have both sides, and operating_point.spool_side = -1 or 1 takes one"
    ))
}
