use crate::rig::RigError;

/// Reason why recordings determine no line.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LineFitError {
    /// The project has no line to identify.
    #[error(transparent)]
    Known(#[from] KnownLineError),
    /// There is more than one slow test.
    #[error("{0} pressure rises are named: one at most is explained at a time")]
    SeveralRises(usize),
    /// There is more than one fast test.
    #[error("{0} frequency responses are named: one at most is explained at a time")]
    SeveralResponses(usize),
    /// There is no recording.
    #[error("there is no recording of a line")]
    NoRecording,
    /// There is no record of a frequency response.
    #[error("there is no record")]
    NoRecord,
    /// The pressure is constant.
    #[error("{file}: the pressure never moves")]
    PressureNeverMoves {
        /// Path of the file.
        file: String,
    },
    /// The volume does not depend on the pressure.
    #[error("{file}: volume and pressure do not move together")]
    Unrelated {
        /// Path of the file.
        file: String,
    },
    /// No search explains the frequency response.
    #[error("{file}: no blocked line has such a response")]
    NoSuchResponse {
        /// Path of the file.
        file: String,
    },
}

/// Reason why a project has no line to identify or to test.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum KnownLineError {
    /// The project has no rig.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// The project has no actuator.
    #[error("the project has no line")]
    NoLine,
    /// The areas of the piston change.
    #[error(
        "lines are identified with a piston of one pair of areas, and those of a telescopic piston change: identify them without [[cylinder.stage]]"
    )]
    Telescopic,
    /// The line has no volume.
    #[error("the line holds no oil")]
    NoOil,
}
