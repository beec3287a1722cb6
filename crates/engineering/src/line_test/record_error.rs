/// Error of a recording of a line.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(super) enum LineRecordError {
    /// The pressure falls while oil enters the line.
    #[error(
        "`{pressure}` falls while `{volume}` fills the line (correlation {correlation:.2} over {rows} rows)"
    )]
    PressureFalls { pressure: String, volume: String, correlation: f64, rows: usize },
    /// There are fewer rows than a test has.
    #[error("{0} rows are too few for a test of a line")]
    TooFewRows(usize),
}

/// Expectation or remedy next to such an error.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(super) enum LineRecordHint {
    /// Expectation of a pressure.
    #[error("a pressure that rises with the oil in the line")]
    RisingPressure,
    /// Remedy of a volume or flow.
    #[error("change the sign of `{0}`")]
    ChangeSign(String),
    /// Expectation of a file: fewest rows.
    #[error("at least {0} rows")]
    AtLeastRows(usize),
}
