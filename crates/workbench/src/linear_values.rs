//! The linear values of a project as plain numbers, for applications that hand them on: transfer
//! functions by their factors, and the plants of the family.

use phea_engineering::setup::Setup;

use crate::command::{self, CommandError, Watch};
pub use crate::plant_values::{Factors, FamilyValues, LoopFactors, MeasuredValues};
use crate::project::Loaded;
use crate::source::Source;

/// Transfer functions that a project declares or that follow from its rig, by their names: `plant`
/// from the command to the force and `load_position` from the position of the load to the force,
/// of a rig with lumped lines; `controller`, `prefilter`, and of a sampled loop both in z as
/// deployed; `sensor`.
///
/// # Errors
/// [`CommandError`] for a controller that is not a transfer function, or a rig that cannot be
/// computed.
///
/// # Example
/// ```
/// use phea_workbench::linear_values::transfer_functions;
/// use phea_workbench::project;
/// use phea_workbench::source::Memory;
/// let source = Memory::default().with("rig.toml", include_str!("../../../examples/ybitu/hose.toml"));
/// let loaded = project::read(&source, "rig.toml", &[], &[])?;
/// let found = transfer_functions(&loaded)?;
/// let names: Vec<_> = found.iter().map(|(name, _)| *name).collect();
/// assert_eq!(names, ["plant", "load_position", "controller", "prefilter", "sensor"]);
/// assert_eq!((found[0].1.poles.len(), found[2].1.gain), (5, 0.001));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn transfer_functions(loaded: &Loaded) -> Result<Vec<(&'static str, Factors)>, CommandError> {
    let setup = Setup::new(&loaded.project)?;
    let mut found = Vec::new();
    if loaded.project.actuator.is_some() {
        let plant = setup.rig()?.plant.coefficients();
        found.push(("plant", Factors::of_coefficients(&plant.command, plant.dead_time_s)?));
        if let Some(disturbance) = &plant.disturbance {
            found.push(("load_position", Factors::of_coefficients(disturbance, 0.0)?));
        }
    }
    if let Some(controller) = &setup.controller {
        found.push(("controller", Factors::of(&controller.feedback.transfer_function()?)));
    }
    if let Some(prefilter) = &setup.prefilter {
        found.push(("prefilter", Factors::of(&prefilter.transfer_function()?)));
    }
    if let (Some(controller), Some(_)) = (&setup.controller, setup.timing.sample_time_s) {
        let deployed = setup.compensation(controller)?;
        found.push(("deployed_controller", Factors::of(deployed.feedback())));
        if setup.prefilter.is_some() {
            found.push(("deployed_prefilter", Factors::of(deployed.prefilter())));
        }
    }
    found.push(("sensor", Factors::of(&setup.sensor)));
    Ok(found)
}

/// Family of a project, with the valve identified from its recordings if the project requires that.
///
/// # Errors
/// [`CommandError`] for a project without a family.
///
/// # Example
/// ```
/// use phea_workbench::linear_values::family_values;
/// use phea_workbench::project;
/// use phea_workbench::source::Memory;
/// let source = Memory::default().with("rig.toml", include_str!("../../../examples/ybitu/hose.toml"));
/// let loaded = project::read(&source, "rig.toml", &[], &[])?;
/// let family = family_values(&source, &loaded, &mut |_| true)?;
/// let nominal = &family.members()[0];
/// assert_eq!(family.parameters().len(), nominal.len());
/// let plant = family.member(nominal).ok_or("a rational plant")?;
/// let [real, imaginary] = family.response(nominal, 1.0).ok_or("a response")?;
/// assert_eq!(plant.poles.len(), 5);
/// assert!(real.is_finite() && imaginary < 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn family_values(
    source: &dyn Source,
    loaded: &Loaded,
    watch: Watch<'_>,
) -> Result<FamilyValues, CommandError> {
    let problem = command::robust_problem_of(source, loaded, watch)?;
    Ok(FamilyValues::of(&problem))
}
