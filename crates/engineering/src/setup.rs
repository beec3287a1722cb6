//! A project, lowered: the values with which every procedure computes, made from the declaration in
//! this one place.
//!
//! ```text
//! Project -> Setup { rig, controller, prefilter, sensor, timing, quantization } -> machine, plant, family, sizing, reductions
//! ```

use phea_dynamics::controller::{Compensator, Controller, Timing};
use phea_dynamics::linear::TransferFunction;
use phea_qft::closed_loop::Compensation;
use phea_qft::design::quantization::{CoefficientFormat, Quantization, rounded};

use crate::control::{self, ControlError};
use crate::project::Project;
use crate::rig::{Rig, RigError};

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
        let rig = Setup::rig_of(project);
        let fed = rig.as_ref().ok().and_then(|rig| rig.fed?.in_loop());
        let timing = match fed {
            None => control::timing(project),
            Some((rate_feed_forward, rate_sensor)) => {
                Timing { rate_feed_forward, rate_sensor, ..control::timing(project) }
            }
        };
        let controller = control::controller(project)?;
        Ok(Setup {
            project,
            controller: controller.map(|given| Controller { timing, ..given }),
            prefilter: control::prefilter(project)?,
            sensor: control::sensor(project)?,
            timing,
            quantization: control::quantization(project)?,
            rig,
        })
    }

    /// The rig of a project alone.
    ///
    /// # Errors
    /// As [`Setup::rig`].
    pub fn rig_of(project: &Project) -> Result<Rig, RigError> {
        Rig::of(project, project.actuator.as_ref().ok_or(RigError::NoActuator)?)
    }

    /// The rig.
    ///
    /// # Errors
    /// [`RigError`] for a project without an actuator, a rig that is impossible, or one without an
    /// equilibrium at its operating point.
    pub fn rig(&self) -> Result<&Rig, RigError> {
        self.rig.as_ref().map_err(Clone::clone)
    }

    /// The same rig and controller for another question: the project may differ only in its
    /// scenarios, specifications and settings.
    pub fn asked<'b>(&self, project: &'b Project) -> Setup<'b> {
        let Setup { controller, prefilter, sensor, timing, quantization, rig, .. } = self.clone();
        Setup { project, controller, prefilter, sensor, timing, quantization, rig }
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
        let linear = |error| ControlError::Linear { place: "[controller]", error };
        Compensation::new(&self.deployed(controller)?, self.sensor.clone()).map_err(linear)
    }
}
