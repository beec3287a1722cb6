//! The outcome of a design as a word.

use phea_engineering::design::DesignVerdict;

use crate::answer::words;

/// Outcome of a design.
pub(super) enum DesignOutcomeKind {
    Met,
    NotProven,
    MissedInTime,
    PrefilterAmplifies,
    CommandBeyondValve,
    DelayNotTolerated,
    Infeasible,
    NotConverged,
    NotStabilised,
    Stopped,
}

words! {
    /// Outcome of a design: every specification satisfied; satisfied over a family that lacks a
    /// declared effect; satisfied, but steps in time, gain of the prefilter, command of steps or
    /// tolerated delay missed; violated by every evaluated controller; no agreement of search and
    /// audit; no evaluated controller that makes every plant stable; or stopped.
    DesignOutcomeKind {
        Met => "met",
        NotProven => "not_proven",
        MissedInTime => "missed_in_time",
        PrefilterAmplifies => "prefilter_amplifies",
        CommandBeyondValve => "command_beyond_valve",
        DelayNotTolerated => "delay_not_tolerated",
        Infeasible => "infeasible",
        NotConverged => "not_converged",
        NotStabilised => "not_stabilised",
        Stopped => "stopped",
    }
}

impl From<&DesignVerdict> for DesignOutcomeKind {
    fn from(verdict: &DesignVerdict) -> DesignOutcomeKind {
        match verdict {
            DesignVerdict::Stopped { .. } => DesignOutcomeKind::Stopped,
            DesignVerdict::NotProven => DesignOutcomeKind::NotProven,
            DesignVerdict::StepsMissed | DesignVerdict::MissedOnRig(_) => DesignOutcomeKind::MissedInTime,
            DesignVerdict::PrefilterAmplifies => DesignOutcomeKind::PrefilterAmplifies,
            DesignVerdict::CommandBeyondValve { .. } => DesignOutcomeKind::CommandBeyondValve,
            DesignVerdict::DelayNotTolerated(_) => DesignOutcomeKind::DelayNotTolerated,
            DesignVerdict::Met { .. } => DesignOutcomeKind::Met,
            DesignVerdict::StepsNotReached(_) | DesignVerdict::Infeasible { .. } => {
                DesignOutcomeKind::Infeasible
            }
            DesignVerdict::Refuted | DesignVerdict::Undecided | DesignVerdict::NotConverged { .. } => {
                DesignOutcomeKind::NotConverged
            }
            DesignVerdict::NotStabilised(_) => DesignOutcomeKind::NotStabilised,
        }
    }
}
