//! Specifications that follow from the converters of a sampled controller: permitted effects of
//! their rounding on force and command.

use phea_qft::specification::Specification;

use super::SpecificationName;
use crate::setup::Setup;

/// Specifications of `allowed_force_error` and `allowed_command_error`, with bounds at these
/// frequencies, rad/s.
pub(crate) fn of_rounding(
    setup: &Setup<'_>,
    frequencies_rad_per_s: &[f64],
) -> Vec<(Specification, SpecificationName)> {
    let Some(declared) = setup.project.controller.as_ref().and_then(|one| one.quantization.as_ref()) else {
        return vec![];
    };
    let quantization = setup.quantization;
    let frequencies = || frequencies_rad_per_s.to_vec();
    let force = declared.allowed_force_error.and_then(|allowed| {
        let found = quantization.force_specification(allowed, frequencies())?;
        Some((found, SpecificationName::RoundedCommand(setup.project.motion())))
    });
    let command = declared.allowed_command_error.and_then(|allowed| {
        let found = quantization.command_specification(allowed, frequencies())?;
        Some((found, SpecificationName::RoundedMeasurement))
    });
    force.into_iter().chain(command).collect()
}
