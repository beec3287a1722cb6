//! Spring between force sensor and load in the plants of a family.

use super::Check;
use super::rig::stall_forces;
use crate::{DeclaredActuator, DeclaredSeries, Project, Uncertain};

/// Checks the uncertain numbers of a spring.
pub(super) fn spring(project: &Project, actuator: &DeclaredActuator, check: &mut Check<'_, '_>) {
    let Some(spring) = actuator.series.as_ref().and_then(DeclaredSeries::spring) else { return };
    let is_soft = |one: &&Uncertain| one.name == "series.stiffness" && one.minimum < spring.stiffness;
    if let Some(softest) = project.uncertainty.iter().find(is_soft) {
        let place = ("uncertainty.series.stiffness", softest.minimum);
        spring.check_travel(place, stall_forces(actuator), check);
    }
    vanishing(project, check);
}

/// Rejects a damper or a mass that may vanish, which would change the order of the plant within one
/// family.
fn vanishing(project: &Project, check: &mut Check<'_, '_>) {
    for key in ["series.damping", "series.mass"] {
        let in_range = project.uncertainty.iter().any(|one| one.name == key && one.minimum <= 0.0);
        let cases = project.family.iter().flat_map(|family| &family.cases);
        let in_case =
            cases.flat_map(|case| &case.parameters).any(|(name, value)| name == key && *value <= 0.0);
        for (place, vanishes) in
            [(format!("uncertainty.{key}"), in_range), ("family.cases".to_string(), in_case)]
        {
            if vanishes {
                let message = format!("`{key}` may vanish here, and a plant without it has another order");
                let help = "let it begin above zero, or leave it at zero and certain";
                check.error_with_help(&place, message, help);
            }
        }
    }
}
