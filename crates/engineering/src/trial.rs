//! The verdict tried on the machine: the nonlinear rig under the controller as it is deployed,
//! compared with what the linear loop predicts.
//!
//! ```text
//! project, audit -> rigs::rigs -> Rigs { project, plant } -> run::run -> Run { linear, machine, agreement, reason } -> answer
//! ```

mod prediction;
mod rigs;
mod run;
pub use run::percent_words;

pub(crate) use rigs::waves_alone;
pub use rigs::with_waves;
pub use run::{Agreement, StepResponse, TrialRun, TrialStep, agreement_word};

use crate::audit::ProjectAudit;
use crate::rig::RigError;
use crate::robust::RobustProblem;
use crate::setup::{ControlError, Setup};
use crate::source::Source;
use phea_dynamics::linear::LinearError;
use phea_dynamics::time_response::TimeResponseError;
use phea_dynamics::watch::{Progress, Stopped, Watch};

/// Why a verdict cannot be tried on the machine.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TrialError {
    /// The rig cannot be computed with.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// The controller, prefilter or sensor is not a transfer function.
    #[error(transparent)]
    Control(#[from] ControlError),
    /// The linear loop cannot be sampled.
    #[error("the linear models: {0}")]
    Linear(#[from] LinearError),
    /// The step response of the linear loop cannot be measured.
    #[error("a response: {0}")]
    Time(#[from] TimeResponseError),
    /// The watch stopped it.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

/// Every run, in the order in which they were driven: the rig as it is declared first.
#[derive(Clone, Debug, PartialEq)]
pub struct Trial {
    /// At least one.
    pub runs: Vec<TrialRun>,
    /// Plants for which no rig was found, and why.
    pub not_driven: Vec<String>,
}

impl Trial {
    /// The worst of all runs.
    pub fn agreement(&self) -> Agreement {
        self.runs.iter().map(|run| run.agreement).max().unwrap_or(Agreement::Agrees)
    }
}

/// Drives the machine of a project, whose controller is the one that was audited; `None` for a
/// project without an actuator.
///
/// # Errors
/// [`TrialError`] for a controller or a sensor that is not a transfer function, and where the
/// watch stops it.
pub fn tried(
    source: &dyn Source,
    setup: &Setup<'_>,
    problem: &RobustProblem,
    view: &ProjectAudit,
    watch: Watch<'_>,
) -> Result<Option<Trial>, TrialError> {
    if setup.project.actuator.is_none() {
        return Ok(None);
    }
    let rig = setup.rig()?;
    let (rigs, not_driven) = rigs::rigs(setup, rig, problem, view);
    let count = rigs.len() as f64;
    let mut runs = Vec::new();
    for (index, rig) in rigs.iter().enumerate() {
        let mut within = |progress: Progress| {
            watch(Progress { stage: "on the machine", share: (index as f64 + progress.share) / count })
        };
        match run::run(source, rig, problem, view, &mut within)? {
            Some(run) => runs.push(run),
            None => return Err(Stopped.into()),
        }
    }
    Ok(Some(Trial { runs, not_driven }))
}
