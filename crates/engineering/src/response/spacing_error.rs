use crate::quantity::{TIME, display};

/// Record whose rows must be even.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EvenlySampled {
    /// Input and output of a plant.
    #[error("a frequency response")]
    FrequencyResponse,
    /// Motion and forces of a piston.
    #[error("a run of the cylinder")]
    CylinderRun,
}

/// Error of the times of a record.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub(super) enum SpacingError {
    /// There are fewer rows than needed for information about a frequency.
    #[error("{rows} rows are too few for {sampled}")]
    TooFewRows { rows: usize, sampled: EvenlySampled },
    /// The rows are uneven; time since the row before, s.
    #[error("{} after the row before", display(*.0, &TIME, 4))]
    After(f64),
}

/// Expectation or remedy next to such an error.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub(super) enum SpacingHint {
    /// Fewest rows.
    #[error("at least {0} rows")]
    AtLeastRows(usize),
    /// Expectation of even rows; usual time between rows, s.
    #[error("evenly sampled rows: {} apart, as most are", display(*.0, &TIME, 4))]
    Apart(f64),
    /// Remedy of uneven rows.
    #[error("interpolating would filter the signals: export the record with the clock of its sampling")]
    ClockOfSampling,
}
