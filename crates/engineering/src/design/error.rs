//! Errors of a design.

use phea_dynamics::linear::LinearError;
use phea_dynamics::watch::Stopped;

use super::Explanation;
use crate::impossible_steps::{ImpossibleSteps, impossible_steps};
use crate::quantity::MotionKind;
use crate::robust::{RobustError, RobustProblem};
use crate::setup::{ControlError, Setup};
use crate::trial::TrialError;

/// Reason why nothing is designed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DesignError {
    /// The project has no specification for a controller.
    #[error(
        "the project states no [[specification]] to design a controller for: add one, such as `kind = \"robust_stability\"` and `limit = 1.3`"
    )]
    NoSpecification,
    /// The given controller is that of a position.
    #[error(
        "a design finds the controller G of the {}, and controller.impedance.form = \"admittance\" states that of the {}: design with \
         form = \"impedance\", which is the same loop, and take C_x = G (M_v s^2 + B_v s + K_v)",
        .0.words().force,
        .0.words().position
    )]
    Admittance(MotionKind),
    /// The search found no controller; with the known facts about the problem.
    #[error("the search ended without a controller")]
    NoController(Vec<Explanation>),
    /// No controller makes the required steps on the rig.
    #[error("no controller makes {} of the required steps on this rig", .0.steps.len())]
    ImpossibleSteps(Box<ImpossibleSteps>),
    /// The search cannot use a part of the problem.
    #[error(transparent)]
    Search(#[from] phea_qft::design::LoopDesignError),
    /// The controller, prefilter or sensor is not a transfer function.
    #[error(transparent)]
    Control(#[from] ControlError),
    /// A linear system cannot be computed.
    #[error("the linear models: {0}")]
    Linear(#[from] LinearError),
    /// The project is not a problem of the robust method.
    #[error(transparent)]
    Robust(#[from] RobustError),
    /// The designed controller cannot be simulated on the machine.
    #[error(transparent)]
    Trial(TrialError),
    /// The pressure feedback is free, but the rig or family admits none.
    #[error(
        "design.pressure_feedback = \"free\" found no feedback: it needs plants of a rig, stable without it, and no gain keeps the limits of its own loop here"
    )]
    NoPressureFeedback,
    /// The progress callback cancelled the design before anything was found.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

impl From<TrialError> for DesignError {
    fn from(error: TrialError) -> DesignError {
        match error {
            TrialError::Stopped(stopped) => DesignError::Stopped(stopped),
            error => DesignError::Trial(error),
        }
    }
}

/// Rejects a project that requires a step that no controller makes on its rig.
pub(super) fn refuse_impossible_steps(setup: &Setup<'_>, problem: &RobustProblem) -> Result<(), DesignError> {
    match impossible_steps(setup, problem) {
        none if none.is_empty() => Ok(()),
        steps => {
            let units = setup.project.units;
            Err(DesignError::ImpossibleSteps(Box::new(ImpossibleSteps { steps, units })))
        }
    }
}
