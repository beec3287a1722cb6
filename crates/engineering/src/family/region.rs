//! Part of an operating region that the pump can supply.

use phea_hydraulics::servovalve::tare_flow;

use super::ProjectFamilyError;
use crate::project::{Project, Uncertain};
use crate::quantity::{VELOCITY, display};
use crate::rig::components;

/// Path of the number that a pump limits.
const PATH: &str = "operating_point.velocity";

/// Uncertain numbers, with the velocity of `[family.operating_region]` limited to the range that
/// the pump can supply at the declared numbers.
///
/// ```text
/// -(q_pump - q_tare)/A_B <= v <= (q_pump - q_tare)/A_A          the chamber that the supply fills; leakage is neglected
/// ```
///
/// # Errors
/// [`ProjectFamilyError::Region`] if nothing remains of the range, or the nominal velocity is not
/// within it.
pub(super) fn within_reach(project: &Project) -> Result<Vec<Uncertain>, ProjectFamilyError> {
    let mut numbers = project.uncertain_numbers();
    let region = project.family.as_ref().and_then(|family| family.operating_region.as_ref());
    let is_velocity = |one: &&mut Uncertain| one.name == PATH;
    let velocity = numbers.iter_mut().find(is_velocity);
    let (Some(velocity), Some([least, most])) = (velocity, limits(project)) else { return Ok(numbers) };
    if region.is_none_or(|region| region.velocity.is_none()) {
        return Ok(numbers);
    }
    velocity.minimum = velocity.minimum.max(least);
    velocity.maximum = velocity.maximum.min(most);
    let within = velocity.minimum..=velocity.maximum;
    if !within.contains(&velocity.nominal) {
        let [nominal, least, most] = [velocity.nominal, least, most]
            .map(|value| display(value, project.motion().dimension(&VELOCITY), 4));
        return Err(ProjectFamilyError::Region { least, most, nominal });
    }
    Ok(numbers)
}

/// Least and greatest velocity that the pump can supply, m/s; `None` if no flow is declared.
pub(super) fn limits(project: &Project) -> Option<[f64; 2]> {
    let declared = project.actuator.as_ref()?;
    let components = components(declared, declared);
    let left = (declared.supply.flow()? - tare_flow(&components.valve, &components.supply)).max(0.0);
    let [area_a, area_b] = components.cylinder.greatest_areas();
    Some([-left / area_b, left / area_a])
}
