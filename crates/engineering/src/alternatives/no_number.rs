use phea_quantity::MotionKind;

use super::JudgeError;
use crate::linearize::NoClosedImpedance;
use crate::parts::PartsUnknown;
use crate::simulate::{RunStatus, Unmeasured};

/// Reason why a column of an alternative has no number.
#[derive(Clone, Debug, PartialEq)]
pub enum NoNumber {
    /// The part of the alternative to which the column belongs is missing.
    NotJudged(JudgeError),
    /// The design did not find the specifications infeasible, and no limit is to be relaxed.
    NotFoundInfeasible,
    /// The family is not known to be stable.
    NotKnownStable,
    /// The specification has no margin in any plant at any frequency.
    NothingToJudgeBy,
    /// The run ended early.
    Stopped {
        /// Time of the end, s.
        time_s: f64,
        /// Status of the run.
        status: RunStatus,
    },
    /// No solver determines the result of the run.
    Undetermined,
    /// The equations of the simulation do not hold.
    OutsideModel {
        /// Time from which they do not hold, s.
        time_s: f64,
    },
    /// The metric does not exist for one of the events.
    NoMetric(Unmeasured, MotionKind),
    /// No event begins in the scenario.
    NoEvent,
    /// No hose of the catalogue is accepted.
    NoHose,
    /// The actuator has no known length.
    Length(LengthUnknown),
    /// A line is stated as a volume.
    LineIsVolume,
    /// There is no accumulator at the chambers.
    NoAccumulator,
    /// A sum over the parts is not known.
    Parts(PartsUnknown),
    /// The closed loop has no impedance, for this reason.
    NoClosedLoop(Option<NoClosedImpedance>),
}

impl From<JudgeError> for NoNumber {
    fn from(error: JudgeError) -> NoNumber {
        NoNumber::NotJudged(error)
    }
}

/// Reason why the retracted length of an actuator is not known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LengthUnknown {
    /// The rig has a motor, which has no length.
    Motor,
    /// `cylinder.dead_length` is not stated.
    NoDeadLength,
    /// `series.coil` is not stated.
    NoCoil,
    /// The coils of the series spring are too few to be wound.
    TooFewCoils,
    /// `series.cylinder_length` is not stated.
    NoSeriesCylinderLength,
}
