//! The words of the status of a run.

use phea_engineering::simulate::RunStatus;

use crate::answer::words;

words! {
    /// Status of a run of a machine.
    RunStatus by RunStatus::key [
        Completed, Refused, StepTooSmall, NotFinite, TooManySteps, UnresolvedOscillation, Diverged,
        OutsideModel, Undetermined, Cancelled, NotStarted,
    ]
}
