//! Runs that were repeated, and runs that diverge.

use phea_engineering::simulate::{Divergence, Pass, PassAgreement, PassSpread, Repetition, RunStatus};

use super::step_counts::StepCountsAnswer;
use crate::answer::{Answer, Reasoned, words};
use crate::quantity::{MotionKind, QuantityName};
use crate::simulate::unmeasured_words;
use phea_hydraulics::signal::Signal;

/// Passes of a run that was repeated because errors may be visible.
#[derive(Answer)]
pub(super) struct RepetitionAnswer {
    /// Agreement of the passes.
    status: PassAgreement,
    /// Passes in order.
    passes: Vec<ScenarioPassAnswer>,
    /// Largest difference between the last two compared passes.
    spread: Reasoned<PassSpreadAnswer>,
}

/// Pass of a run that was repeated.
#[derive(Answer)]
struct ScenarioPassAnswer {
    /// Tolerance of the integration.
    tolerance: f64,
    /// True if each state begins a few roundings away from its start value.
    moved_start: bool,
    /// Status of the pass.
    status: RunStatus,
    #[answer(flatten)]
    work: StepCountsAnswer,
}

/// Largest difference between two passes.
#[derive(Answer)]
struct PassSpreadAnswer {
    /// Number of the event, from 1.
    event: Reasoned<usize>,
    /// Name of the metric, or of the force if there is no metric.
    metric: QuantityName,
    /// Value of the earlier pass, in the unit of the metric.
    before: Reasoned<f64>,
    /// Value of the later pass, in the unit of the metric.
    after: Reasoned<f64>,
    /// Ratio of the difference to the metric, of an overshoot to the step, of a steady-state error
    /// to the largest deviation of the event; `inf` if one pass has no such number.
    part: f64,
}

words! {
    /// Agreement of the passes of a repeated run: the last two agree to a thousandth, they do not
    /// at the smallest tolerance, roundings at the start change the result, or a pass ended early.
    PassAgreement {
        Agreed => "agreed",
        Apart => "apart",
        Undetermined => "undetermined",
        Stopped => "stopped",
    }
}

/// Divergence of a run that reached its end.
#[derive(Answer)]
pub(super) struct DivergenceAnswer {
    /// Kind of the divergence.
    kind: Divergence,
    /// Time at which it begins, or at which the force is largest.
    since_s: f64,
    #[answer(flatten)]
    values: DivergenceValues,
}

words! {
    /// Kind of a divergence: a command that remains at the end of its range or beyond, one that
    /// swings from end to end, or a force of more than ten times the largest reference.
    Divergence {
        CommandBeyondRange { .. } => "command_beyond_range",
        CommandSwings { .. } => "command_swings",
        ForceBeyondReference { .. } => "force_beyond_reference",
    }
}

/// Values of a divergence, by its kind.
#[derive(Answer)]
enum DivergenceValues {
    CommandBeyondRange {
        /// Range of the command to either side of zero.
        range_v: f64,
    },
    CommandSwings {
        /// Range of the command to either side of zero.
        range_v: f64,
        /// Number of swings from one end of the range to the other until the end of the run.
        swings: u32,
    },
    ForceBeyondReference {
        /// Largest magnitude of the force at the end of the run.
        #[answer(key = Signal::Force.quantity())]
        force: f64,
        /// Largest magnitude of the reference.
        #[answer(key = Signal::Reference.quantity())]
        reference: f64,
    },
}

/// The passes of a run.
pub(super) fn repetition(repetition: &Repetition, motion: MotionKind) -> RepetitionAnswer {
    RepetitionAnswer {
        status: repetition.agreement,
        passes: repetition.passes.iter().map(pass).collect(),
        spread: Reasoned::new(
            repetition.spread.map(|one| spread(&one, motion)),
            "the passes have no number in common",
        ),
    }
}

fn pass(pass: &Pass) -> ScenarioPassAnswer {
    ScenarioPassAnswer {
        tolerance: pass.plan.tolerance,
        moved_start: pass.plan.moved,
        status: pass.stopped.map_or(RunStatus::Completed, |stopped| stopped.status),
        work: pass.work.into(),
    }
}

fn spread(spread: &PassSpread, motion: MotionKind) -> PassSpreadAnswer {
    let [before, after] =
        spread.values.map(|value| Reasoned::of(value.map_err(|why| unmeasured_words(why, motion))));
    PassSpreadAnswer {
        event: Reasoned::new(spread.of.map(|(window, _)| window + 1), "no event has a metric"),
        metric: spread.of.map_or(Signal::Force.quantity(), |(_, metric)| metric.quantity()),
        before,
        after,
        part: spread.part,
    }
}

/// The divergence of a run.
pub(super) fn divergence(divergence: Divergence) -> DivergenceAnswer {
    let values = match divergence {
        Divergence::CommandBeyondRange { range_v, .. } => DivergenceValues::CommandBeyondRange { range_v },
        Divergence::CommandSwings { range_v, swings, .. } => {
            DivergenceValues::CommandSwings { range_v, swings }
        }
        Divergence::ForceBeyondReference { force_n, reference_n, .. } => {
            DivergenceValues::ForceBeyondReference { force: force_n, reference: reference_n }
        }
    };
    DivergenceAnswer { kind: divergence, since_s: divergence.since_s(), values }
}
