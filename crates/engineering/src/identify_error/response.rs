/// Record without a frequency response.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{file}: {fault}")]
pub struct ResponseFitError {
    /// Path of the file.
    pub file: String,
    /// Reason.
    pub fault: RecordFault,
}

/// Reason for which a record has no frequency response.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RecordFault {
    /// A constant input.
    #[error("the input never moves, so that it excites nothing")]
    InputNeverMoves,
    /// A closed loop without a recorded reference.
    #[error(
        "the loop was closed, and no column says what moved it: `{output}` over `{input}` tends to the negative inverse of the controller, -1/C; record the reference in a column `reference`, `excitation` or `set_point`, make the reference periodic, or, where [controller] of the project is that of the test, state `controller = \"declared\"` in its [[identify.response]]"
    )]
    NoReference {
        /// Name of the input.
        input: &'static str,
        /// Name of the output.
        output: &'static str,
    },
    /// An input that follows the noise of the output, although no closed loop is stated.
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
    /// Fewer rows than segments need.
    #[error("{rows} rows are too few for segments of {length} rows")]
    TooFewForSegments {
        /// Rows after the settling.
        rows: usize,
        /// Rows of a segment.
        length: usize,
    },
    /// Fewer rows than a band of frequencies needs.
    #[error("{rows} rows are too few for a frequency response")]
    TooFewRows {
        /// Rows after the settling.
        rows: usize,
    },
    /// A loop that nothing moved from outside.
    #[error(
        "{moving} moves the input at no frequency more than noise does: nothing moved the loop from outside"
    )]
    NotMoved {
        /// Signal that should move it.
        moving: MovingSignal,
    },
    /// A reference that moves the loop less than noise.
    #[error(
        "at no frequency is noise small against what {moving} moves: the squared coherence is below {least:.2}; move the reference more, or longer"
    )]
    MovedTooLittle {
        /// Signal that moves it.
        moving: MovingSignal,
        /// Least squared coherence.
        least: f64,
    },
    /// An output that does not depend on the input.
    #[error("at no frequency does the output depend on the input with a squared coherence of {least:.2}")]
    Incoherent {
        /// Least squared coherence.
        least: f64,
    },
    /// A stated period that is not a whole number of rows. s.
    #[error(
        "a period of {stated} s is {rows:.4} rows of {time_step} s; a period of whole rows has no leakage: {} s or {} s",
        whole[0],
        whole[1]
    )]
    PeriodOfPartRows {
        /// Stated period.
        stated: f64,
        /// Rows of it.
        rows: f64,
        /// Time between rows.
        time_step: f64,
        /// Periods of whole rows below and above.
        whole: [f64; 2],
    },
    /// A record shorter than its settling and two periods. s.
    #[error(
        "{length:.4} s are too short: after {settling:.4} s for the transient, at least two periods of {period:.4} s are needed, whose difference shows how much is noise"
    )]
    TooShort {
        /// Duration of the record.
        length: f64,
        /// Duration that is left out.
        settling: f64,
        /// Period.
        period: f64,
    },
    /// A command at its limit.
    #[error(
        "`{input}` is at the limit of [controller] in {rows} rows, in which it does not follow from `{output}`: record the reference, or move it less"
    )]
    AtLimit {
        /// Name of the input.
        input: &'static str,
        /// Name of the output.
        output: &'static str,
        /// Rows at the limit.
        rows: usize,
    },
    /// A command that follows from the output alone.
    #[error(
        "`{input}` follows from `{output}` by [controller] within rounding: nothing moved the loop from outside"
    )]
    FollowsFromOutput {
        /// Name of the input.
        input: &'static str,
        /// Name of the output.
        output: &'static str,
    },
    /// A calculated reference with the noise of the output.
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

/// Signal that moves a loop from outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MovingSignal {
    /// A recorded reference, by its name.
    #[error("the column `{0}`")]
    Column(&'static str),
    /// A reference that follows from the declared controller.
    #[error("the reference that is calculated with [controller], y + u/C,")]
    Calculated,
}
