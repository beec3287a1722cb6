//! Common position of the piston in all plants of a family.

use crate::quantity::Units;
use crate::setup::Setup;

/// A position that no plant of the family varies, m, or rad for a motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CommonPosition {
    /// Position from the end of chamber A.
    pub position: f64,
    /// Length of the stroke.
    pub stroke: f64,
    /// Motion of the rig.
    pub units: Units,
}

impl CommonPosition {
    /// `None` without a rig, for a motor of unlimited rotation, and if the family varies the
    /// position, or the stiffness that depends on it, or the project states that stiffness.
    pub(crate) fn of(setup: &Setup<'_>) -> Option<CommonPosition> {
        let project = setup.project;
        let mut varied = project.uncertain_numbers().into_iter();
        let is_varied = varied
            .any(|one| ["operating_point.position", "hydraulic_stiffness"].contains(&one.name.as_str()));
        if is_varied || project.linear.hydraulic_stiffness.is_some() {
            return None;
        }
        let rig = setup.rig().ok()?;
        let stroke = rig.actuator.components().cylinder.stroke.length()?;
        Some(CommonPosition { position: rig.point.position, stroke, units: project.units })
    }
}
