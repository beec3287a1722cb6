//! Runs that were repeated, and runs that diverge, for people.

use phea_engineering::simulate::{Divergence, Measured, PassAgreement, PassSpread, Repetition, ScenarioRun};

use super::{shown_in, status_words};
use crate::answer::significant;
use crate::quantity::{DisplayUnit, Units, VOLTAGE, display};
use phea_dynamics::simulation::{GrowthCause, UnfollowedCause, UnfollowedKinks};

/// Words for the way in which a run diverges.
pub(super) fn divergence_words(divergence: &Divergence, units: Units) -> String {
    let since = DisplayUnit::SECOND.number(divergence.since_s(), 4);
    match *divergence {
        Divergence::CommandBeyondRange { range_v, .. } => format!(
            "from {since} s to the end the command is at the end of the valve's range of {}, or beyond: the loop does not come back",
            display(range_v, &VOLTAGE, 4)
        ),
        Divergence::CommandSwings { range_v, swings, .. } => format!(
            "from {since} s to the end the command swings {swings} times from one end of the valve's range of {} to the other while no \
             input moves: the loop does not come to rest",
            display(range_v, &VOLTAGE, 4)
        ),
        Divergence::ForceBeyondReference { force_n, reference_n, .. } => format!(
            "the {} comes to {} at {since} s, more than ten times the largest reference of {}, and nothing else moves the load",
            units.motion.words().force,
            units.force.short(force_n, 4),
            units.force.short(reference_n, 4)
        ),
    }
}

/// Results that may depend on the tolerance, and the outcome of repeating the run.
pub(super) fn sentences(run: &ScenarioRun) -> Vec<String> {
    let grown = run.errors_amplified.map(|grown| {
        let [from, until] = [grown.from_s, grown.until_s].map(|time| DisplayUnit::SECOND.number(time, 4));
        let frequency = significant(grown.frequency_rad_per_s, 3);
        let what = match grown.cause {
            GrowthCause::Mode => format!("a mode of {frequency} rad/s grows"),
            GrowthCause::Loop => format!("the closed loop is unstable: its mode of {frequency} rad/s grows"),
            GrowthCause::Motion => {
                "deviations grow from kink to kink, as from one bounce to the next,".to_string()
            }
        };
        format!("from {from} to {until} s {what} so much that errors within the tolerance may become visible")
    });
    let repeated = run.repetition.as_ref().map(|repetition| agreement_words(run, repetition));
    let unknown = "the run was not repeated: `--check` estimates how far its result depends on them";
    let doubt = grown.is_some() && repeated.is_none();
    let judged = repeated.is_some() || doubt || run.check.is_some();
    let unfollowed = run.unfollowed.filter(|_| !judged).map(unfollowed_words);
    let sentences = grown.into_iter().chain(repeated);
    sentences.chain(doubt.then(|| unknown.to_string())).chain(unfollowed).collect()
}

fn unfollowed_words(kinks: UnfollowedKinks) -> String {
    let cause = match kinks.cause {
        UnfollowedCause::Samples => "in a sampled loop",
        UnfollowedCause::Delays => "through a delay or a line with waves",
        UnfollowedCause::Method => "by an explicit method",
    };
    format!(
        "the motion passes kinks, as friction, stops and contacts have; {cause} the growth of a deviation from one to the next is not \
         followed: `--check` estimates the error"
    )
}

fn agreement_words(run: &ScenarioRun, repetition: &Repetition) -> String {
    let tolerance = significant(run.tolerance, 2);
    let apart = repetition
        .spread
        .map_or("they have no number in common".to_string(), |spread| apart(&spread, run.record.units));
    match repetition.agreement {
        PassAgreement::Agreed => format!(
            "so the run was repeated until its metrics agreed to a thousandth, at a tolerance of {tolerance}; of the last two passes, \
             {apart}"
        ),
        PassAgreement::Apart => format!(
            "repeated down to a tolerance of {tolerance} its metrics do not agree to a thousandth: of the last two passes, {apart}; no \
             number is more exact than that"
        ),
        PassAgreement::Undetermined => format!(
            "even rounding becomes visible: a start moved by a few roundings gives another result ({apart}), so that no solver determines \
             it"
        ),
        PassAgreement::Stopped => {
            let stopped = repetition.passes.last().and_then(|pass| Some((pass.plan, pass.stopped?)));
            let why = stopped.map_or(String::new(), |(plan, stopped)| {
                format!(
                    ": a pass at a tolerance of {} ended as {}",
                    significant(plan.tolerance, 2),
                    status_words(stopped.status)
                )
            });
            format!("the result at a tolerance of {tolerance} could not be confirmed{why}")
        }
    }
}

/// The quantity that differs most, in words.
fn apart(spread: &PassSpread, units: Units) -> String {
    let name = spread.of.map_or(units.motion.words().force, |(_, metric)| metric.label(units.motion));
    let unit = spread.of.map_or(units.force, |(_, metric)| shown_in(metric, units));
    let event = spread.of.map_or(String::new(), |(window, _)| format!(" of event {}", window + 1));
    let number = |value: Measured| match value {
        Ok(value) => unit.text(value, 5),
        Err(_) => "none".to_string(),
    };
    let [before, after] = spread.values.map(number);
    if spread.part.is_finite() {
        let percent = significant(100.0 * spread.part, 2);
        format!("the {name}{event} differs most: {before} and {after}, {percent} %")
    } else {
        format!("the {name}{event} is {before} and {after}")
    }
}

/// Steps of the run that is reported, and of all passes.
pub(super) fn work_words(run: &ScenarioRun) -> String {
    let work = format!("{} steps, {} rejected", run.work.steps, run.work.rejected);
    match &run.repetition {
        None => work,
        Some(repetition) => {
            format!("{work}; {} steps in {} passes", repetition.steps(), repetition.passes.len())
        }
    }
}
