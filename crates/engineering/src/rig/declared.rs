//! A declared rig over any scalar: in its own numbers, or with those of a family in their place.

use phea_dynamics::scalar::Scalar;
use phea_hydraulics::actuator::Components;

use super::assembly::components;
use crate::project::{DeclaredActuator, DeclaredOperatingPoint, Load, OpenRig, Project};

/// Declared rig with its operating point, over any scalar.
#[derive(Clone, Debug)]
pub struct DeclaredRig<'a, S = f64> {
    /// Project of the rig.
    pub(crate) project: &'a Project,
    /// Actuator in its own numbers.
    pub(crate) plain: &'a DeclaredActuator,
    /// Actuator over the scalar.
    pub(crate) actuator: DeclaredActuator<S>,
    /// Operating point over the scalar.
    pub(crate) operating_point: DeclaredOperatingPoint<S>,
    /// Paths of the open numbers.
    open: &'a [String],
}

impl<'a> DeclaredRig<'a> {
    /// The rig in its own numbers.
    pub fn plain(project: &'a Project, plain: &'a DeclaredActuator) -> DeclaredRig<'a> {
        let operating_point = project.resolved_operating_point();
        DeclaredRig { project, plain, actuator: plain.clone(), operating_point, open: &[] }
    }
}

impl<'a, S: Scalar> DeclaredRig<'a, S> {
    /// The rig with these values of the numbers at these paths, which `table` has open.
    pub fn open(
        project: &'a Project,
        plain: &'a DeclaredActuator,
        table: &OpenRig,
        paths: &'a [String],
        values: &[S],
    ) -> DeclaredRig<'a, S> {
        let (actuator, operating_point) = (table.actuator(values), table.operating_point(values));
        DeclaredRig { project, plain, actuator, operating_point, open: paths }
    }

    /// Components of the rig, not yet checked.
    pub fn components(&self) -> Components<S> {
        components(self.plain, &self.actuator)
    }

    /// True if the load is a mass that nothing holds, whatever the open numbers are.
    pub(crate) fn has_free_mass(&self) -> bool {
        matches!(self.plain.load, Load::SpringMassDamper { stiffness: 0.0, .. })
            && self.open.iter().all(|path| path != "load.stiffness")
    }

    /// True if the load touches a wall without a gap.
    pub(crate) fn touches_wall(&self) -> bool {
        matches!(self.plain.load, Load::Wall { gap: 0.0, .. })
    }
}
