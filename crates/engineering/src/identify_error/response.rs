/// A record without a frequency response.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{file}: {fault}")]
pub struct ResponseFitError {
    /// Path of the file.
    pub file: String,
    /// Fault of the record.
    pub fault: RecordFault,
}

/// Reason why a record has no frequency response.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RecordFault {
    /// The input is constant.
    #[error("the input never moves, so that it excites nothing")]
    InputNeverMoves,
    /// The loop is closed, without a recorded reference.
    #[error(
        "the loop was closed, and no column says what moved it: `{output}` over `{input}` tends to the negative inverse of the controller, -1/C; record the reference in a column `reference`, `excitation` or `set_point`, make the reference periodic, or, where [controller] of the project is that of the test, state `controller = \"declared\"` in its [[identify.response]]"
    )]
    NoReference {
        /// Name of the input.
        input: &'static str,
        /// Name of the output.
        output: &'static str,
    },
    /// The input follows the noise of the output, although no closed loop is stated.
    #[error(
        "the loop was closed during the test: `{input}` follows the noise of `{output}` ({:.0} % of its innovation), so that `{output}` over `{input}` tends to the negative inverse of the controller, -1/C; record the reference in a column `reference`, `excitation` or `set_point`, make the reference periodic, or, where [controller] of the project is that of the test, state `controller = \"declared\"` in its [[identify.response]]. Where no controller acted, state `loop = \"open\"` in its [[identify.response]]",
        100.0 * fraction
    )]
    FollowsNoise {
        /// Name of the input.
        input: &'static str,
        /// Name of the output.
        output: &'static str,
        /// Fraction of the innovation of the input.
        fraction: f64,
    },
    /// There are fewer rows than segments need.
    #[error("{rows} rows are too few for segments of {length} rows")]
    TooFewForSegments {
        /// Number of rows after the settling.
        rows: usize,
        /// Number of rows of a segment.
        length: usize,
    },
    /// There are fewer rows than a band of frequencies needs.
    #[error("{rows} rows are too few for a frequency response")]
    TooFewRows {
        /// Number of rows after the settling.
        rows: usize,
    },
    /// No signal excited the loop from outside.
    #[error(
        "{moving} moves the input at no frequency more than noise does: nothing moved the loop from outside"
    )]
    NotMoved {
        /// Signal that should excite it.
        moving: MovingSignal,
    },
    /// The reference excites the loop less than noise.
    #[error(
        "at no frequency is noise small against what {moving} moves: the squared coherence is below {least:.2}; move the reference more, or longer"
    )]
    MovedTooLittle {
        /// Signal that excites it.
        moving: MovingSignal,
        /// Least squared coherence.
        least: f64,
    },
    /// The output does not depend on the input.
    #[error("at no frequency does the output depend on the input with a squared coherence of {least:.2}")]
    Incoherent {
        /// Least squared coherence.
        least: f64,
    },
    /// The stated period is not a whole number of rows.
    #[error(
        "a period of {stated} s is {rows:.4} rows of {time_step} s; a period of whole rows has no leakage: {} s or {} s",
        whole[0],
        whole[1]
    )]
    PeriodOfPartRows {
        /// Stated period, s.
        stated: f64,
        /// Number of rows of the period.
        rows: f64,
        /// Time between rows, s.
        time_step: f64,
        /// Periods of whole rows below and above, s.
        whole: [f64; 2],
    },
    /// The record is shorter than its settling and two periods.
    #[error(
        "{length:.4} s are too short: after {settling:.4} s for the transient, at least two periods of {period:.4} s are needed, whose difference shows how much is noise"
    )]
    TooShort {
        /// Duration of the record, s.
        length: f64,
        /// Omitted duration, s.
        settling: f64,
        /// Period, s.
        period: f64,
    },
    /// The command is at its limit.
    #[error(
        "`{input}` is at the limit of [controller] in {rows} rows, in which it does not follow from `{output}`: record the reference, or move it less"
    )]
    AtLimit {
        /// Name of the input.
        input: &'static str,
        /// Name of the output.
        output: &'static str,
        /// Number of rows at the limit.
        rows: usize,
    },
    /// The command follows only from the output.
    #[error(
        "`{input}` follows from `{output}` by [controller] within rounding: nothing moved the loop from outside"
    )]
    FollowsFromOutput {
        /// Name of the input.
        input: &'static str,
        /// Name of the output.
        output: &'static str,
    },
    /// The calculated reference has the noise of the output.
    #[error(
        "[controller] was not that of the test: the reference that is calculated with it, y + u/C, follows the noise of `{output}` ({:.0} % of its innovation); declare its gain, `sample_time` and `delay` as they were in the test, or record the reference",
        100.0 * fraction
    )]
    OtherController {
        /// Name of the output.
        output: &'static str,
        /// Fraction of the innovation of the reference.
        fraction: f64,
    },
}

/// Signal that excites a loop from outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MovingSignal {
    /// A recorded reference, by its name.
    #[error("the column `{0}`")]
    Column(&'static str),
    /// A reference that follows from the declared controller.
    #[error("the reference that is calculated with [controller], y + u/C,")]
    Calculated,
}
