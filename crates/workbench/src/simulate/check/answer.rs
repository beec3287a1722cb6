//! A check, in an answer and for people.

use super::{Cause, Difference, Metric, MetricDifferences, ToleranceCheck};
use crate::answer::{Answer, Reasoned, significant};
use crate::quantity::{FORCE, MotionKind, QuantityName, Units};
use crate::simulate::{RunStatus, unmeasured_words};

/// Difference between the reported run and one at a tenth of its tolerance.
#[derive(Answer)]
pub(crate) struct ToleranceCheckAnswer {
    /// Tolerance of the second run.
    tolerance: f64,
    /// Status of the second run; the comparison extends to its end.
    status: RunStatus,
    /// Time between two compared samples.
    sample_interval_s: f64,
    /// Largest magnitude of the difference of the force.
    #[answer(key = QuantityName::OfMotion(["force_difference", "torque_difference"], &FORCE))]
    force_difference: Reasoned<f64>,
    /// Ratio of that difference to the largest magnitude of force and reference in both runs.
    part_of_peak: Reasoned<f64>,
    /// Differences of the command and of all signals of the machine.
    signals: Vec<SignalDifferenceAnswer>,
    /// Differences of the metrics of each event.
    events: Vec<EventDifferenceAnswer>,
}

/// Largest difference of a signal between two runs, in the SI unit of the signal.
#[derive(Answer)]
struct SignalDifferenceAnswer {
    /// Name of the signal.
    name: QuantityName,
    /// Largest magnitude of the difference.
    difference: f64,
    /// Time of that difference.
    time_s: f64,
    /// Largest magnitude in both runs and, for the force, of the reference.
    peak: f64,
    /// Ratio of the difference to the peak; zero if nothing moves.
    part_of_peak: f64,
}

/// Differences of the metrics of an event between two runs.
#[derive(Answer)]
struct EventDifferenceAnswer {
    /// Kind of the event.
    kind: Cause,
    /// Time of the event, from the start of the scenario.
    time_s: f64,
    /// Differences of all metrics.
    metrics: Vec<MetricDifferenceAnswer>,
}

/// Difference of a metric between two runs.
#[derive(Answer)]
struct MetricDifferenceAnswer {
    /// Name of the metric.
    name: QuantityName,
    /// Magnitude of the difference, in the unit of the metric.
    difference: Reasoned<f64>,
}

/// The check of a run.
pub(crate) fn answer(check: &ToleranceCheck, motion: MotionKind) -> ToleranceCheckAnswer {
    const APART: &str = "the two runs have no sample in common";
    let force = check.force.as_ref();
    ToleranceCheckAnswer {
        tolerance: check.tolerance,
        status: check.stopped.map_or(RunStatus::Completed, |stopped| stopped.status),
        sample_interval_s: check.sample_interval_s,
        force_difference: Reasoned::new(force.map(|force| force.difference), APART),
        part_of_peak: Reasoned::new(force.map(Difference::part_of_peak), APART),
        signals: check.signals.iter().map(signal).collect(),
        events: check.metrics.iter().map(|found| event(found, motion)).collect(),
    }
}

fn signal(found: &Difference) -> SignalDifferenceAnswer {
    SignalDifferenceAnswer {
        name: found.signal.quantity(),
        difference: found.difference,
        time_s: found.time_s,
        peak: found.peak,
        part_of_peak: found.part_of_peak(),
    }
}

fn event(found: &MetricDifferences, motion: MotionKind) -> EventDifferenceAnswer {
    let metrics = Metric::ALL.map(|metric| MetricDifferenceAnswer {
        name: metric.quantity(),
        difference: Reasoned::of(found.differences[metric].map_err(|why| unmeasured_words(why, motion))),
    });
    EventDifferenceAnswer { kind: found.window.cause, time_s: found.window.start_s, metrics: metrics.into() }
}

/// The findings of a check, a sentence each.
pub(crate) fn sentences(check: &ToleranceCheck, units: Units) -> Vec<String> {
    let tolerance = significant(check.tolerance, 3);
    let mut warnings = Vec::new();
    if let Some(stopped) = check.stopped {
        warnings.push(format!(
            "the check at the tolerance {tolerance} ended at {} s: later nothing is compared",
            significant(stopped.time_s, 6)
        ));
    }
    let Some(force) = &check.force else { return warnings };
    warnings.push(format!(
        "checked at the tolerance {tolerance}: the {} differs by {} at {} s, {} of its peak{}",
        units.motion.words().force,
        units.force.text(force.difference, 2),
        significant(force.time_s, 6),
        significant(force.part_of_peak(), 2),
        of_disturbance(check, units)
    ));
    if check.is_doubtful() {
        warnings.push(
            "that is more than a thousandth: take its numbers for no more exact than this, or state a smaller `simulation.tolerance`; \
             where that does not bring them closer, they depend on details that no solver resolves"
                .to_string(),
        );
    }
    warnings
}

/// The difference of the disturbance peak, where the load moves.
fn of_disturbance(check: &ToleranceCheck, units: Units) -> String {
    let found = check.metrics.iter().find_map(|metrics| metrics.differences[Metric::DisturbancePeak].ok());
    found.map_or(String::new(), |found| format!("; the disturbance peak by {}", units.force.text(found, 2)))
}
