//! Reasons why a run lacks a number, a saved end, accounts or a closed loop.

use super::{NoClosedLoop, NoLedger, NotSaved, RunStatus, Unmeasured};
use crate::quantity::MotionKind;

/// Status of a run.
pub(crate) fn status_words(status: RunStatus) -> &'static str {
    match status {
        RunStatus::Completed => "completed",
        RunStatus::Refused => "refused",
        RunStatus::StepTooSmall => "step too small",
        RunStatus::NotFinite => "not finite",
        RunStatus::TooManySteps => "too many steps",
        RunStatus::UnresolvedOscillation => "unresolved oscillation",
        RunStatus::Diverged => "diverged",
        RunStatus::OutsideModel => "outside model",
        RunStatus::Undetermined => "undetermined",
        RunStatus::Cancelled => "cancelled",
        RunStatus::NotStarted => "not started",
    }
}

/// Reason why a number of a run is absent.
pub(crate) fn unmeasured_words(reason: Unmeasured, motion: MotionKind) -> &'static str {
    match reason {
        Unmeasured::AfterEnd => "the run ended before",
        Unmeasured::NoStep => "the reference does not step",
        Unmeasured::NoMotion => "the load does not begin to move",
        Unmeasured::NotReached => motion.either(
            "the force does not reach 90 % of the step",
            "the torque does not reach 90 % of the step",
        ),
        Unmeasured::BegunBeyond => motion.either(
            "the force is already beyond 10 % of the step when it begins",
            "the torque is already beyond 10 % of the step when it begins",
        ),
        Unmeasured::NotSettled => "outside the band in the last tenth of the window",
        Unmeasured::ReferenceMoves => "the reference moves",
        Unmeasured::OpenLoop => "open loop: there is no reference",
        Unmeasured::ReferenceGiven => motion.either(
            "the reference says which force there should be",
            "the reference says which torque there should be",
        ),
        Unmeasured::ReferenceConstant => "the reference stands still",
        Unmeasured::ZeroReference => "the reference is zero: a band around it has no width",
        Unmeasured::OneRunHasNone => "one of the two runs has none",
        Unmeasured::NoRow => "no row of the file lies within what was simulated",
        Unmeasured::NoSignal => "the scenario has no such signal",
        Unmeasured::NoRange => "what was measured does not change: there is no range to divide by",
    }
}

/// Reason why the end of a run is not saved.
pub(super) fn not_saved_words(reason: NotSaved) -> &'static str {
    match reason {
        NotSaved::NotCompleted => "it was not completed",
        NotSaved::Motor => "the states of a motor are not saved yet",
        NotSaved::Linkage => "the states of a rig with a linkage are not saved yet",
        NotSaved::InTransit => "what is in transit in a delay or along a line is not a state",
        NotSaved::BetweenSamples => "it ends between two samples of the controller",
        NotSaved::CommandDelayed => "a command is under way in the delay of the controller",
    }
}

/// Reason why a run has no accounts.
pub(super) fn no_ledger_words(reason: NoLedger) -> &'static str {
    match reason {
        NoLedger::NotRequested => "the accounts of this run were not requested",
        NoLedger::InTransit => "waves in transit along a line are in no account",
    }
}

/// Reason why a machine has no closed loop.
pub(super) fn no_closed_loop_words(reason: NoClosedLoop, motion: MotionKind) -> &'static str {
    match reason {
        NoClosedLoop::Stopped => "it was stopped before",
        NoClosedLoop::NoController => "the project gives no controller",
        NoClosedLoop::NoReference => motion.either(
            "no reference holds the force of the operating point",
            "no reference holds the torque of the operating point",
        ),
        NoClosedLoop::Open => "the loop is open",
    }
}
