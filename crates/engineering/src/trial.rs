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
use crate::error::ProcedureError;
use crate::robust::RobustProblem;
use crate::setup::Setup;
use crate::source::Source;
use phea_dynamics::watch::{Progress, Watch};

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
/// [`ProcedureError`] for a controller or a sensor that is not a transfer function, and where the
/// watcher stops it.
pub fn tried(
    source: &dyn Source,
    setup: &Setup<'_>,
    problem: &RobustProblem,
    view: &ProjectAudit,
    watch: Watch<'_>,
) -> Result<Option<Trial>, ProcedureError> {
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
            None => return Err(ProcedureError::Stopped),
        }
    }
    Ok(Some(Trial { runs, not_driven }))
}
