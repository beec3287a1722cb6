//! Specifications that the converters of a sampled controller make: how much of their rounding may reach force and command.

use phea_qft::specification::Specification;

use crate::control::{ControlError, quantisation};
use crate::project::Project;

/// A specification and what it is called.
pub(crate) type Named = (Specification, &'static str);

/// The specifications of `allowed_force_error` and `allowed_command_error`, with bounds at these frequencies, rad/s.
///
/// # Errors
/// [`ControlError::Quantisation`] for a converter that is none.
pub(crate) fn of_rounding(
    project: &Project,
    frequencies_rad_per_s: &[f64],
) -> Result<Vec<Named>, ControlError> {
    let Some(declared) = project.controller.as_ref().and_then(|one| one.quantization.as_ref()) else {
        return Ok(vec![]);
    };
    let quantisation = quantisation(project)?;
    let frequencies = || frequencies_rad_per_s.to_vec();
    let force = declared.allowed_force_error.and_then(|allowed| {
        Some((
            quantisation.force_specification(allowed, frequencies())?,
            "force error of the rounded command",
        ))
    });
    let command = declared.allowed_command_error.and_then(|allowed| {
        let found = quantisation.command_specification(allowed, frequencies())?;
        Some((found, "command error of the rounded measurement"))
    });
    Ok(force.into_iter().chain(command).collect())
}
