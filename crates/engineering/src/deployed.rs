//! The controller of a project as its computer executes it.

use phea_dynamics::controller::Controller;
use phea_dynamics::linear::LinearError;
use phea_machine::Deployed;

use crate::rig::RigError;
use crate::setup::{ControlError, LawPlace, Setup};

/// Reason why the controller of a project cannot run on a computer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DeployedError {
    /// The project gives no controller.
    #[error("there is no controller: state [controller] with `elements` or a transfer function")]
    NoController,
    /// The controller acts continuously.
    #[error("a controller without `sample_time` acts continuously, and a computer runs it once per sample")]
    Continuous,
    /// The prefilter acts before the sampler.
    #[error("a prefilter with `continuous = true` acts before the sampler, and is not in the computer")]
    ContinuousPrefilter,
    /// The virtual impedance acts on the measured motion continuously.
    #[error(
        "the virtual impedance acts continuously on the measured motion of the load in every model, and a computer would sample it, which was not verified"
    )]
    VirtualImpedance,
    /// The controller cannot be sampled or rounded.
    #[error(transparent)]
    Control(#[from] ControlError),
    /// The velocity that is fed forward is that of a rig that is impossible.
    #[error(transparent)]
    Rig(#[from] RigError),
}

/// A controller that acts once per sample, with the converters and the feedforward of a project.
///
/// # Errors
/// A compensator that cannot be discretised.
pub(crate) fn executed(
    setup: &Setup<'_>,
    controller: &Controller,
    sample_time_s: f64,
    feed_forward: f64,
) -> Result<Deployed, LinearError> {
    let sensor = setup.project.actuator.as_ref().and_then(|actuator| actuator.velocity_sensor.as_ref());
    Ok(Deployed {
        controller: controller.sampled(sample_time_s)?,
        feed_forward,
        velocity_resolution: sensor.map_or(0.0, |sensor| sensor.resolution),
        measurement_converter: setup.quantization.measurement,
        command_converter: setup.quantization.command,
    })
}

/// The controller of a project as its computer executes it, with rounded coefficients.
///
/// # Errors
/// [`DeployedError`].
///
/// # Example
/// ```
/// use phea_engineering::deployed::{DeployedError, deployed};
/// use phea_engineering::setup::Setup;
/// use phea_project::source::Memory;
/// let text = include_str!("../../../examples/ybitu/hose.toml");
/// let source = Memory::default().with("rig.toml", text);
/// let read = |settings: &[String]| phea_project::read(&source, "rig.toml", settings, &[]);
/// let continuous = read(&[])?;
/// assert_eq!(deployed(&Setup::new(&continuous.project)?), Err(DeployedError::Continuous));
/// let sampled = read(&["controller.sample_time=1 ms".to_string()])?;
/// assert_eq!(deployed(&Setup::new(&sampled.project)?)?.controller.sample_time_s(), 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn deployed(setup: &Setup<'_>) -> Result<Deployed, DeployedError> {
    let controller = setup.controller.as_ref().ok_or(DeployedError::NoController)?;
    let sample_time_s = controller.timing.sample_time_s.ok_or(DeployedError::Continuous)?;
    if controller.timing.continuous_prefilter {
        return Err(DeployedError::ContinuousPrefilter);
    }
    if setup.virtual_impedance.is_some() {
        return Err(DeployedError::VirtualImpedance);
    }
    let feed_forward = match setup.project.actuator {
        Some(_) => setup.rig()?.feed_forward(),
        None => 0.0,
    };
    let rounded = setup.deployed(controller)?;
    let linear = |error| ControlError::Linear { place: LawPlace::Controller, error };
    Ok(executed(setup, &rounded, sample_time_s, feed_forward).map_err(linear)?)
}
