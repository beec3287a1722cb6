/// Reason why recorded tests determine no valve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ValveFitError {
    /// The outputs are constant.
    #[error("no recorded signal changes: there is nothing to fit")]
    NothingChanges,
    /// There are fewer rows than coefficients.
    #[error("the recordings have too few rows to fit a valve")]
    TooFewRows,
}
