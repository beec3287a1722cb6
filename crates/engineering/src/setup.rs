//! A project, lowered: the values with which every procedure computes, made from the declaration in
//! this one place.
//!
//! ```text
//! Project -> Setup { rig, controller, prefilter, sensor, timing, quantization } -> machine, plant, family, sizing, reductions
//! ```

mod control;

use phea_dynamics::controller::{Compensator, Controller, RateSensor, Timing, VirtualImpedance};
use phea_dynamics::linear::TransferFunction;
use phea_qft::closed_loop::Compensation;
use phea_qft::design::quantization::{CoefficientFormat, Quantization, rounded};

use crate::project::Project;
use crate::rig::{OutsideParameter, Rig, RigError, outside};

pub use control::{ControlError, LawPlace};
pub(crate) use control::{
    element, from_formulas, is_of_position, pressure_noise, velocity_noise, with_pressure_feedback,
};

/// The rig of a project with its controller, as values to compute with. A rig with a changed number
/// is another setup.
#[derive(Clone, Debug)]
pub struct Setup<'a> {
    /// The declaration with its specifications, scenarios and wishes.
    pub project: &'a Project,
    /// The given controller with its prefilter; `None` where the project gives no transfer function
    /// for one.
    pub controller: Option<Controller>,
    /// The given prefilter; `None` where the project gives none.
    pub prefilter: Option<Compensator>,
    /// H; 1 where the project declares no sensor.
    pub sensor: TransferFunction,
    /// When the controller acts, whether it is given or to be designed; continuous and without
    /// delay where the project does not say.
    pub timing: Timing,
    /// The rounding in the controller's computer: none where the project does not say.
    pub quantization: Quantization,
    /// Filter and dead time of the sensor of the load's velocity; none where the project declares
    /// no sensor.
    pub velocity_sensor: RateSensor,
    /// The virtual impedance of the loop; `None` where there is none, or one of zero.
    pub virtual_impedance: Option<VirtualImpedance>,
    rig: Result<Rig, RigError>,
}

impl<'a> Setup<'a> {
    /// Lowers a project.
    ///
    /// # Errors
    /// [`ControlError`] for a controller, prefilter or sensor that is not a transfer function. An
    /// error of the rig is reported when the rig is needed.
    ///
    /// # Example
    /// ```
    /// use phea_engineering::setup::Setup;
    /// use phea_project::source::Memory;
    /// let source = Memory::default().with("rig.toml", include_str!("../../../examples/ybitu/hose.toml"));
    /// let loaded = phea_project::read(&source, "rig.toml", &[], &[])?;
    /// let setup = Setup::new(&loaded.project)?;
    /// assert!((setup.rig()?.linear.sensor_stiffness - 2e7).abs() < 1.0);
    /// assert!(setup.controller.is_some_and(|given| given.timing == setup.timing));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(project: &'a Project) -> Result<Setup<'a>, ControlError> {
        Setup::around(project, Setup::rig_of(project))
    }

    /// The same of a project whose rig is known.
    pub(crate) fn around(
        project: &'a Project,
        rig: Result<Rig, RigError>,
    ) -> Result<Setup<'a>, ControlError> {
        let fed = rig.as_ref().ok().and_then(|rig| rig.fed?.in_loop());
        let timing = control::timing(project);
        let timing = fed.map_or(timing, |(rate_feed_forward, rate_sensor)| Timing {
            rate_feed_forward,
            rate_sensor,
            ..timing
        });
        let mut controller = control::controller(project, timing)?;
        let prefilter = control::prefilter(project, &timing)?;
        if let (Some(controller), Some(prefilter)) = (&mut controller, &prefilter) {
            controller.prefilter = prefilter.clone();
        }
        Ok(Setup {
            project,
            controller,
            prefilter,
            sensor: control::sensor(project)?,
            timing,
            quantization: control::quantization(project)?,
            velocity_sensor: control::velocity_sensor(project),
            virtual_impedance: control::virtual_impedance(project),
            rig,
        })
    }

    /// The rig of a project alone.
    ///
    /// # Errors
    /// As [`Setup::rig`].
    pub fn rig_of(project: &Project) -> Result<Rig, RigError> {
        let declared = project.actuator.as_ref().ok_or(RigError::NoActuator)?;
        let sensor = control::velocity_sensor(project);
        Rig::of(project, declared, sensor, control::virtual_impedance(project))
    }

    /// The rig.
    ///
    /// # Errors
    /// [`RigError`] for a project without an actuator, a rig that is impossible, or one without an
    /// equilibrium at its operating point.
    pub fn rig(&self) -> Result<&Rig, RigError> {
        self.rig.as_ref().map_err(Clone::clone)
    }

    /// The project without its uncertainty, and the parameters of the rig that the box does not
    /// contain. `None` where the box contains the rig, or there is no rig.
    pub fn outside(&self) -> Option<(Project, Vec<OutsideParameter>)> {
        outside(self.project, self.rig.as_ref().ok()?)
    }

    /// The same rig and controller for another question: the project may differ only in its
    /// scenarios, specifications and settings.
    pub fn for_project<'b>(&self, project: &'b Project) -> Setup<'b>
    where
        'a: 'b,
    {
        Setup { project, ..self.clone() }
    }

    /// A controller as the project's computer runs it: in z with rounded coefficients, or unchanged
    /// where nothing is rounded.
    ///
    /// # Errors
    /// [`ControlError::Quantization`] for coefficients that cannot be stored.
    pub fn deployed(&self, controller: &Controller) -> Result<Controller, ControlError> {
        match self.quantization.coefficients {
            CoefficientFormat::Double => Ok(controller.clone()),
            format => Ok(rounded(controller, format)?.controller),
        }
    }

    /// The loop around the plant with a controller as it is deployed.
    ///
    /// # Errors
    /// [`ControlError`] if it cannot be sampled or rounded.
    pub fn compensation(&self, controller: &Controller) -> Result<Compensation, ControlError> {
        let linear = |error| ControlError::Linear { place: LawPlace::Controller, error };
        Compensation::new(&self.deployed(controller)?, self.sensor.clone()).map_err(linear)
    }
}
