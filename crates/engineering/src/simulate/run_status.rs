//! The status of a run.

use phea_dynamics::simulation::Status;

/// Status of a run of a machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunStatus {
    /// The run reached its end, with numbers that describe the machine.
    Completed,
    /// The run did not begin: the drawn machine is invalid.
    Refused,
    /// No step is short enough for the tolerance.
    StepTooSmall,
    /// A state derivative is no longer a number.
    NotFinite,
    /// The permitted steps are used up.
    TooManySteps,
    /// An oscillation grows that would need more steps than are permitted.
    UnresolvedOscillation,
    /// The run reached its end, but diverged.
    Diverged,
    /// The run reached its end, but left the validity of its equations.
    OutsideModel,
    /// The run reached its end, but no two of its repetitions give one result.
    Undetermined,
    /// The progress callback cancelled the run.
    Cancelled,
    /// The run did not begin: the machine has no equilibrium or no equations.
    NotStarted,
}

impl RunStatus {
    /// Statuses of the rows of a campaign, in the order in which they are counted.
    pub const OF_ROWS: [RunStatus; 9] = [
        RunStatus::Completed,
        RunStatus::Refused,
        RunStatus::StepTooSmall,
        RunStatus::NotFinite,
        RunStatus::TooManySteps,
        RunStatus::UnresolvedOscillation,
        RunStatus::Diverged,
        RunStatus::OutsideModel,
        RunStatus::Undetermined,
    ];

    /// Word of the status in JSON and in tables.
    ///
    /// # Example
    /// ```
    /// use phea_engineering::simulate::RunStatus;
    /// assert_eq!(RunStatus::StepTooSmall.key(), "step_too_small");
    /// assert!(RunStatus::OF_ROWS.iter().all(|status| RunStatus::of_row(status.key()) == Some(*status)));
    /// assert_eq!(RunStatus::of_row("cancelled"), None);
    /// ```
    pub const fn key(self) -> &'static str {
        match self {
            RunStatus::Completed => "completed",
            RunStatus::Refused => "refused",
            RunStatus::StepTooSmall => "step_too_small",
            RunStatus::NotFinite => "not_finite",
            RunStatus::TooManySteps => "too_many_steps",
            RunStatus::UnresolvedOscillation => "unresolved_oscillation",
            RunStatus::Diverged => "diverged",
            RunStatus::OutsideModel => "outside_model",
            RunStatus::Undetermined => "undetermined",
            RunStatus::Cancelled => "cancelled",
            RunStatus::NotStarted => "not_started",
        }
    }

    /// The status of a row of a campaign by its word.
    pub fn of_row(key: &str) -> Option<RunStatus> {
        RunStatus::OF_ROWS.into_iter().find(|status| status.key() == key)
    }

    /// The status of an integration.
    pub(super) fn of(status: Status) -> RunStatus {
        match status {
            Status::Completed => RunStatus::Completed,
            Status::Cancelled { .. } => RunStatus::Cancelled,
            Status::StepTooSmall { .. } => RunStatus::StepTooSmall,
            Status::NotFinite { .. } => RunStatus::NotFinite,
            Status::TooManySteps { .. } => RunStatus::TooManySteps,
            Status::UnresolvedOscillation { .. } => RunStatus::UnresolvedOscillation,
        }
    }
}
