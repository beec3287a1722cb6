/// Reason for which recorded tests determine no valve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ValveFitError {
    /// Constant outputs.
    #[error("no recorded signal changes: there is nothing to fit")]
    NothingChanges,
    /// Fewer rows than coefficients.
    #[error("the recordings have too few rows to fit a valve")]
    TooFewRows,
}
