//! Reason why a command has no answer: the one error of everything that the workbench computes.

mod place;
mod tables;
mod task_result;
mod words;

pub use task_result::TaskResultError;
pub(crate) use words::design_error_words;

use phea_dynamics::linear::LinearError;
use phea_dynamics::time_response::TimeResponseError;
use phea_dynamics::watch::Stopped;
use phea_engineering::alternatives::AlternativesError;
use phea_engineering::audit::AuditError;
use phea_engineering::bench::BenchError;
use phea_engineering::campaign::CampaignError;
use phea_engineering::deployed::DeployedError;
use phea_engineering::design::DesignError;
use phea_engineering::family::ProjectFamilyError;
use phea_engineering::identify_error::IdentifyError;
use phea_engineering::linear_loop::LoopError;
use phea_engineering::linearize::SweepError;
use phea_engineering::option::OptionError;
use phea_engineering::replaced::ReplacedError;
use phea_engineering::rig::RigError;
use phea_engineering::robust::{BoundsError, RobustError};
use phea_engineering::setup::ControlError;
use phea_engineering::shaping::ShapingError;
use phea_engineering::simulate::SimulateError;
use phea_engineering::sizing::SizingError;
use phea_engineering::specification::SpecificationError;
use phea_engineering::trial::TrialError;

use crate::identify::ValveInUseError;
use crate::project::{Diagnostic, Loaded, Refusal, Severity, refused};
use crate::source::Source;

/// Reason why a valid project has no answer.
#[derive(Debug, thiserror::Error)]
pub enum CommandError {
    /// The rig cannot be computed with.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// The controller is not a transfer function.
    #[error(transparent)]
    Control(#[from] ControlError),
    /// A linear system cannot be computed.
    #[error("the linear models: {0}")]
    Linear(#[from] LinearError),
    /// A response in time cannot be computed.
    #[error("a response: {0}")]
    Time(#[from] TimeResponseError),
    /// The loop cannot be closed.
    #[error("the linear loop: {0}")]
    Loop(#[from] LoopError),
    /// A value of an option is invalid.
    #[error(transparent)]
    Option(#[from] OptionError),
    /// The catalogue, or a project that was changed, cannot be read.
    #[error("{0}")]
    Refused(Refusal),
    /// The quantity to size for is not stated in the project.
    #[error("{0}")]
    Sizing(#[from] SizingError),
    /// No alternatives are judged.
    #[error(transparent)]
    Alternatives(AlternativesError),
    /// Results of alternatives cannot be joined.
    #[error(transparent)]
    AlternativeResults(#[from] TaskResultError),
    /// Nothing to audit.
    #[error(transparent)]
    Audit(AuditError),
    /// Nothing to design for, or no design was found.
    #[error("{}", design_error_words(.0))]
    Design(DesignError),
    /// No family of plants.
    #[error(transparent)]
    Family(#[from] ProjectFamilyError),
    /// A specification cannot be met by any loop, or is contradictory.
    #[error(transparent)]
    Specification(#[from] SpecificationError),
    /// Templates or bounds cannot be computed.
    #[error(transparent)]
    Bounds(BoundsError),
    /// The family cannot be compared with the ranges that it replaces.
    #[error(transparent)]
    Replaced(#[from] ReplacedError),
    /// A controller cannot be shaped in this way.
    #[error(transparent)]
    Shaping(ShapingError),
    /// The machine cannot be simulated.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
    /// The machine of one project among several cannot be simulated.
    #[error("{path}: {error}")]
    Compare {
        /// Path of the project.
        path: String,
        /// Reason why it cannot be simulated.
        error: SimulateError,
    },
    /// The controller cannot run on a computer.
    #[error(transparent)]
    Deployed(#[from] DeployedError),
    /// The controller cannot run in ros2_control.
    #[error(
        "ros2_control updates a controller a whole number of times per second: choose a sample time such as 1 ms or 0.8 ms"
    )]
    UpdateRate,
    /// The title of the project gives no name of a program.
    #[error(
        "exported files are named by the title of the project: begin it with a letter from A to Z, and not with a word that C reserves"
    )]
    NoIdentifier,
    /// The valve cannot be tested.
    #[error(transparent)]
    Bench(#[from] BenchError),
    /// No campaign.
    #[error(transparent)]
    Campaign(#[from] CampaignError),
    /// The recordings of the project give no information on its valve.
    #[error("{0}")]
    Identify(IdentifyError),
    /// The recordings of the project give no valve in place of the declared one.
    #[error(transparent)]
    ValveInUse(ValveInUseError),
    /// A plant that is not an actuator, without specifications.
    #[error(
        "a report on a [plant] needs at least one [[specification]]; one on a rig needs [valve], [cylinder] and [line]"
    )]
    NothingToReport,
    /// A command that does nothing with a motor.
    #[error(
        "`phea {command}` is for a [cylinder], and this project has a [motor]: check, linearize, verify, design, simulate, compare, campaign, alternatives and report accept one"
    )]
    OfCylinders {
        /// Name of the command.
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
    /// The watch stopped a long procedure.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

impl CommandError {
    /// Converts the error into a refusal of the project, at the first key or table that the error
    /// names and that the project has; at the end of the file if the project has none of them.
    pub(crate) fn into_refusal(self, source: &dyn Source, loaded: &Loaded) -> CommandError {
        let mut at_the_end = None;
        for late in place::late(&self, &loaded.project) {
            let mut refusal = refused(source, loaded, &late);
            // the warnings of the project were reported when it was read
            refusal.diagnostics.retain(|found| found.severity == Severity::Error);
            let of_late = |found: &&Diagnostic| found.message == late.message && found.line > 0;
            match refusal.diagnostics.iter().find(of_late) {
                Some(found) if is_at_the_end(found, loaded) => drop(at_the_end.get_or_insert(refusal)),
                Some(_) => return CommandError::Refused(refusal),
                None => {}
            }
        }
        at_the_end.map_or(self, CommandError::Refused)
    }

    /// The findings, if files that the project names were rejected, with a place for each.
    pub fn refusal(&self) -> Option<&Refusal> {
        match self {
            CommandError::Refused(refusal) | CommandError::Shaping(ShapingError::Refused(refusal)) => {
                Some(refusal)
            }
            CommandError::Family(ProjectFamilyError::Measurement(refusal))
            | CommandError::Campaign(CampaignError::Settings(refusal))
            | CommandError::Identify(IdentifyError::Files(refusal)) => Some(refusal),
            CommandError::Simulate(error)
            | CommandError::Compare { error, .. }
            | CommandError::Campaign(CampaignError::Simulate(error)) => error.refusal(),
            _ => None,
        }
    }

    /// True if a file could not be written or read back, although the request was valid.
    pub fn is_of_files(&self) -> bool {
        matches!(
            self,
            CommandError::Simulate(SimulateError::Write(_))
                | CommandError::Campaign(
                    CampaignError::RowStore(_) | CampaignError::Simulate(SimulateError::Write(_))
                )
        )
    }
}

/// True if a finding points past the last entry of the project file.
fn is_at_the_end(found: &Diagnostic, loaded: &Loaded) -> bool {
    found.file == loaded.path && found.span.start >= loaded.bytes.len()
}

// The error of an inner procedure is returned unchanged.

impl From<RobustError> for CommandError {
    fn from(error: RobustError) -> CommandError {
        match error {
            RobustError::Control(error) => error.into(),
            RobustError::Linear(error) => error.into(),
            RobustError::Family(error) => error.into(),
            RobustError::Specification(error) => error.into(),
        }
    }
}

impl From<BoundsError> for CommandError {
    fn from(error: BoundsError) -> CommandError {
        match error {
            BoundsError::Stopped(stopped) => stopped.into(),
            error => CommandError::Bounds(error),
        }
    }
}

impl From<AuditError> for CommandError {
    fn from(error: AuditError) -> CommandError {
        match error {
            AuditError::Robust(error) => error.into(),
            AuditError::Stopped(stopped) => stopped.into(),
            error => CommandError::Audit(error),
        }
    }
}

impl From<TrialError> for CommandError {
    fn from(error: TrialError) -> CommandError {
        match error {
            TrialError::Rig(error) => error.into(),
            TrialError::Control(error) => error.into(),
            TrialError::Linear(error) => error.into(),
            TrialError::Time(error) => error.into(),
            TrialError::Stopped(stopped) => stopped.into(),
        }
    }
}

impl From<DesignError> for CommandError {
    fn from(error: DesignError) -> CommandError {
        match error {
            DesignError::Control(error) => error.into(),
            DesignError::Linear(error) => error.into(),
            DesignError::Robust(error) => error.into(),
            DesignError::Trial(error) => error.into(),
            DesignError::Stopped(stopped) => stopped.into(),
            error => CommandError::Design(error),
        }
    }
}

impl From<ShapingError> for CommandError {
    fn from(error: ShapingError) -> CommandError {
        match error {
            ShapingError::Control(error) => error.into(),
            ShapingError::Linear(error) => error.into(),
            ShapingError::Robust(error) => error.into(),
            ShapingError::Bounds(error) => error.into(),
            ShapingError::Stopped(stopped) => stopped.into(),
            error => CommandError::Shaping(error),
        }
    }
}

impl From<SweepError> for CommandError {
    fn from(error: SweepError) -> CommandError {
        match error {
            SweepError::Option(error) => error.into(),
            SweepError::Refused(refusal) => CommandError::Refused(refusal),
        }
    }
}

impl From<AlternativesError> for CommandError {
    fn from(error: AlternativesError) -> CommandError {
        match error {
            AlternativesError::NoSpecification(error) => error.into(),
            AlternativesError::Option(error) => error.into(),
            AlternativesError::Refused(refusal) => CommandError::Refused(refusal),
            error => CommandError::Alternatives(error),
        }
    }
}

impl From<ValveInUseError> for CommandError {
    fn from(error: ValveInUseError) -> CommandError {
        match error {
            ValveInUseError::Identify(error) => error.into(),
            error => CommandError::ValveInUse(error),
        }
    }
}

impl From<IdentifyError> for CommandError {
    fn from(error: IdentifyError) -> CommandError {
        match error {
            IdentifyError::Stopped => Stopped.into(),
            error => CommandError::Identify(error),
        }
    }
}
