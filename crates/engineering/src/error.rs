//! Why a procedure that is made of several has no result.

use phea_project::{LateError, Refusal};

use crate::audit::AuditError;
use crate::bench::BenchError;
use crate::campaign::CampaignError;
use crate::design::DesignError;
use crate::family::ProjectFamilyError;
use crate::rig::RigError;
use crate::setup::ControlError;
use crate::shaping::ShapingError;
use crate::simulate::SimulateError;
use crate::sizing::SizingError;

/// Why a procedure that is made of several has no result: the error of the one that failed.
#[derive(Debug, thiserror::Error)]
pub enum ProcedureError {
    /// The rig cannot be computed with.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// The controller is not a transfer function.
    #[error(transparent)]
    Control(#[from] ControlError),
    /// A linear system cannot be computed.
    #[error("the linear models: {0}")]
    Linear(#[from] phea_dynamics::linear::LinearError),
    /// A response in time cannot be computed.
    #[error("a response: {0}")]
    Time(#[from] phea_dynamics::time_response::TimeResponseError),
    /// The loop cannot be closed.
    #[error("the linear loop: {0}")]
    Loop(#[from] crate::linear_loop::LoopError),
    /// A quantity of the command line is wrong.
    #[error("--{option} {text}: {message}")]
    Option {
        /// Name of the option.
        option: &'static str,
        /// As written.
        text: String,
        /// What is wrong with it.
        message: String,
    },
    /// The catalogue, or a project that was changed, cannot be read.
    #[error("{0}")]
    Catalogue(Refusal),
    /// The project does not say what to size for.
    #[error("{0}")]
    Sizing(#[from] SizingError),
    /// There is only the project itself.
    #[error(
        "the project has no [[alternative]]: add one with `name` and `set = {{ \"line.length\" = \"3 m\" }}`"
    )]
    NoAlternative,
    /// An alternative that cannot be prepared.
    #[error("alternative `{name}`: {reason}")]
    Alternative {
        /// Its name.
        name: String,
        /// What is wrong, and what to do.
        reason: String,
    },
    /// There is nothing to audit.
    #[error(transparent)]
    Audit(#[from] AuditError),
    /// There is nothing to design for, or nothing was found.
    #[error(transparent)]
    Design(#[from] DesignError),
    /// There is no family of plants.
    #[error(transparent)]
    Family(#[from] ProjectFamilyError),
    /// A specification cannot be met by any loop, or is contradictory.
    #[error(transparent)]
    Specification(#[from] crate::specification::SpecificationError),
    /// Templates or bounds cannot be computed.
    #[error(transparent)]
    Robust(#[from] crate::robust::RobustError),
    /// The family cannot be compared with what it replaces.
    #[error(transparent)]
    Replaced(#[from] crate::replaced::ReplacedError),
    /// A controller cannot be shaped in this way.
    #[error(transparent)]
    Shaping(#[from] ShapingError),
    /// The machine cannot be simulated.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
    /// The valve cannot be tested.
    #[error(transparent)]
    Bench(#[from] BenchError),
    /// There is no campaign.
    #[error(transparent)]
    Campaign(#[from] CampaignError),
    /// The watch stopped a long procedure.
    #[error("stopped")]
    Stopped,
}

impl From<phea_dynamics::watch::Stopped> for ProcedureError {
    fn from(_: phea_dynamics::watch::Stopped) -> ProcedureError {
        ProcedureError::Stopped
    }
}

impl ProcedureError {
    /// The findings, if files that the project names were rejected, with a place for each.
    pub fn refusal(&self) -> Option<&Refusal> {
        match self {
            ProcedureError::Catalogue(report) => Some(report),
            ProcedureError::Family(ProjectFamilyError::Measurement(report)) => Some(report),
            ProcedureError::Shaping(ShapingError::Refused(report)) => Some(report),
            ProcedureError::Campaign(CampaignError::Settings(report)) => Some(report),
            ProcedureError::Simulate(error) | ProcedureError::Campaign(CampaignError::Simulate(error)) => {
                error.refusal()
            }
            _ => None,
        }
    }

    /// The error at the place of a key, where the project has one: known only where its rig is
    /// computed.
    pub fn late(&self) -> Option<LateError> {
        let rig = match self {
            ProcedureError::Rig(error)
            | ProcedureError::Family(ProjectFamilyError::Rig(error))
            | ProcedureError::Sizing(SizingError::Rig(error))
            | ProcedureError::Simulate(SimulateError::Rig(error))
            | ProcedureError::Bench(BenchError::Rig(error)) => error,
            _ => return None,
        };
        match rig {
            RigError::Accumulator(empty) => Some(empty.at()),
            _ => None,
        }
    }

    /// Whether a file could not be written or read back, although the request was valid.
    pub fn is_of_files(&self) -> bool {
        matches!(
            self,
            ProcedureError::Simulate(SimulateError::Write(_))
                | ProcedureError::Campaign(
                    CampaignError::RowStore(_) | CampaignError::Simulate(SimulateError::Write(_))
                )
        )
    }
}
