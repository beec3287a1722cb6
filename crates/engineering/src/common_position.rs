//! The position of the piston at which every plant of a family is taken.

use crate::quantity::Units;
use crate::setup::Setup;

/// A position in m, or in rad of a motor, that no plant of the family varies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CommonPosition {
    /// From the end of chamber A.
    pub position: f64,
    /// The length of the stroke.
    pub stroke: f64,
    /// Motion of the rig.
    pub units: Units,
}

impl CommonPosition {
    /// `None` without a rig, of a motor that turns on, and where the family varies the position, or
    /// the stiffness that depends on it, or the project states that stiffness.
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
