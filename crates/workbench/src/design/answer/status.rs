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
    /// Outcome of a design: every specification is satisfied (`met`), or over a family that lacks a
    /// declared effect, or all but steps in time, the gain of the prefilter, the command of steps
    /// or the tolerated delay; no evaluated controller satisfies them, search and audit disagree,
    /// no evaluated controller makes every plant stable, or the design was stopped.
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
