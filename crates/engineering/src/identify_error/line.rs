use crate::rig::RigError;

/// Reason for which recordings determine no line.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LineFitError {
    /// The project has no line to identify.
    #[error(transparent)]
    Known(#[from] KnownLineError),
    /// More than one slow test.
    #[error("{0} pressure rises are named: one at most is explained at a time")]
    SeveralRises(usize),
    /// More than one fast test.
    #[error("{0} frequency responses are named: one at most is explained at a time")]
    SeveralResponses(usize),
    /// No recording.
    #[error("there is no recording of a line")]
    NoRecording,
    /// No record of a frequency response.
    #[error("there is no record")]
    NoRecord,
    /// A constant pressure.
    #[error("{file}: the pressure never moves")]
    PressureNeverMoves {
        /// Path of the file.
        file: String,
    },
    /// A volume that does not depend on the pressure.
    #[error("{file}: volume and pressure do not move together")]
    Unrelated {
        /// Path of the file.
        file: String,
    },
    /// A frequency response that no search explains.
    #[error("{file}: no blocked line has such a response")]
    NoSuchResponse {
        /// Path of the file.
        file: String,
    },
}

/// Reason for which a project has no line to identify or to test.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum KnownLineError {
    /// No rig.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// No actuator.
    #[error("the project has no line")]
    NoLine,
    /// A piston whose areas change.
    #[error(
        "lines are identified with a piston of one pair of areas, and those of a telescopic piston change: identify them without [[cylinder.stage]]"
    )]
    Telescopic,
    /// A line without volume.
    #[error("the line holds no oil")]
    NoOil,
}
