//! Why a command has no answer: the one error of everything that the workbench computes.

use phea_engineering::error::ProcedureError;
use phea_engineering::identify::IdentifyError;

use crate::project::{Loaded, Refusal, refused};
use crate::simulate::SimulateError;
use crate::source::Source;

/// Why a valid project has no answer.
#[derive(Debug, thiserror::Error)]
pub enum CommandError {
    /// A procedure has no result.
    #[error(transparent)]
    Procedure(ProcedureError),
    /// The recordings of the project say nothing of its valve.
    #[error("{0}")]
    Identify(IdentifyError),
    /// A plant that is not an actuator, without specifications.
    #[error(
        "a report on a [plant] needs at least one [[specification]]; one on a rig needs [valve], [cylinder] and [line]"
    )]
    NothingToReport,
    /// A command that does nothing with a motor.
    #[error(
        "`phea {command}` is for a [cylinder], and this project has a [motor]: check, linearize, verify, design, simulate, compare, campaign, alternatives and report treat one"
    )]
    OfCylinders {
        /// As it is called.
        command: &'static str,
    },
    /// Projects side by side of which some move along a line and others turn.
    #[error(
        "{path} has a [motor] and {other} a [cylinder]: their numbers have different units, and cannot be compared"
    )]
    MixedMotion {
        /// Path of the project with a motor.
        path: String,
        /// Path of the other.
        other: String,
    },
    /// The machine of one project among several cannot be simulated.
    #[error("{path}: {error}")]
    Compare {
        /// Path of the project.
        path: String,
        /// Why not.
        error: SimulateError,
    },
}

impl CommandError {
    /// Why recordings give nothing that could take the place of what is declared.
    pub(crate) fn of_recordings(error: IdentifyError) -> CommandError {
        match error {
            IdentifyError::Stopped => CommandError::Procedure(ProcedureError::Stopped),
            error => CommandError::Identify(error),
        }
    }

    /// The same error; where a name of the catalogue was looked for late, as the refusal of the
    /// project.
    pub(crate) fn into_refusal(self, source: &dyn Source, loaded: &Loaded) -> CommandError {
        let CommandError::Procedure(procedure) = &self else { return self };
        match procedure.late() {
            Some(late) => ProcedureError::Catalogue(refused(source, loaded, &late)).into(),
            None => self,
        }
    }

    /// The findings, if files that the project names were rejected, with a place for each.
    pub fn refusal(&self) -> Option<&Refusal> {
        match self {
            CommandError::Procedure(error) => error.refusal(),
            CommandError::Compare { error, .. } => error.refusal(),
            CommandError::Identify(IdentifyError::Files(refusal)) => Some(refusal),
            CommandError::Identify(_)
            | CommandError::OfCylinders { .. }
            | CommandError::MixedMotion { .. }
            | CommandError::NothingToReport => None,
        }
    }

    /// Whether a file could not be written or read back, although the request was valid.
    pub fn is_of_files(&self) -> bool {
        matches!(self, CommandError::Procedure(error) if error.is_of_files())
    }
}

impl<E: Into<ProcedureError>> From<E> for CommandError {
    fn from(error: E) -> CommandError {
        CommandError::Procedure(error.into())
    }
}
