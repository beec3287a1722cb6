//! Reasons why nothing is identified from recordings: of a valve, of frequency responses, of a line
//! and of a friction.

mod friction;
mod line;
mod response;
mod valve;

pub use friction::{FrictionFitError, UnsteadyRun};
pub use line::{KnownLineError, LineFitError};
pub use response::{MovingSignal, RecordFault, ResponseFitError};
pub use valve::ValveFitError;

use phea_dynamics::watch::Stopped;

use crate::project::Refusal;
use crate::rig::RigError;
use crate::setup::ControlError;

/// Reason why nothing was identified.
#[derive(Debug, thiserror::Error)]
pub enum IdentifyError {
    /// Files are rejected.
    #[error("{0}")]
    Files(Box<Refusal>),
    /// The request names nothing to identify.
    #[error(transparent)]
    Nothing(#[from] NothingToIdentify),
    /// The recorded tests determine no valve.
    #[error(transparent)]
    Valve(#[from] ValveFitError),
    /// A record has no frequency response.
    #[error(transparent)]
    Response(#[from] ResponseFitError),
    /// The recordings determine no line.
    #[error(transparent)]
    Line(#[from] LineFitError),
    /// The recorded runs determine no friction.
    #[error(transparent)]
    Friction(#[from] FrictionFitError),
    /// The project has no rig.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// The declared controller is not a transfer function.
    #[error(transparent)]
    Control(#[from] ControlError),
    /// The progress callback cancelled the identification.
    #[error("stopped")]
    Stopped,
}

impl From<Stopped> for IdentifyError {
    fn from(_: Stopped) -> IdentifyError {
        IdentifyError::Stopped
    }
}

/// Files or projects that a request to identify lacks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NothingToIdentify {
    /// Tests of a valve.
    #[error("there is no recorded test: name files, or declare `[[identify.recording]]` in the project")]
    NoTest,
    /// Records of a frequency response.
    #[error("there is no record: name a file for each member, or declare it in [[identify.response]]")]
    NoRecord,
    /// The project of a line.
    #[error("`--of line` needs the project of the line: its volume, its length and the oil in it")]
    NoProjectOfLine,
    /// Recordings of a line.
    #[error("there is no recording: name files, or declare `line` in `[identify]` of the project")]
    NoLineRecording,
    /// The project of a cylinder.
    #[error("friction needs the project of the cylinder, for its areas and its moving mass: name it")]
    NoProjectOfCylinder,
    /// Runs of a cylinder.
    #[error("there is no recorded run: name files, or declare `friction` in `[identify]` of the project")]
    NoRun,
}
