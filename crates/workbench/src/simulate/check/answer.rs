//! What a check says, in an answer and to people.

use serde::Serialize;

use super::{Difference, MetricDifferences, ToleranceCheck};
use crate::answer::significant;
use crate::simulate::Measured;

#[derive(Serialize)]
pub(crate) struct CheckRow {
    tolerance: f64,
    status: &'static str,
    look_s: f64,
    force_difference_n: Option<f64>,
    force_difference_n_reason: Option<&'static str>,
    part_of_peak: Option<f64>,
    part_of_peak_reason: Option<&'static str>,
    signals: Vec<SignalRow>,
    events: Vec<EventCheckAnswer>,
}

#[derive(Serialize)]
struct SignalRow {
    name: &'static str,
    difference: f64,
    time_s: f64,
    peak: f64,
    part_of_peak: f64,
}

#[derive(Serialize)]
struct EventCheckAnswer {
    kind: &'static str,
    time_s: f64,
    metrics: Vec<MetricCheckAnswer>,
}

#[derive(Serialize)]
struct MetricCheckAnswer {
    name: &'static str,
    difference: Option<f64>,
    difference_reason: Option<&'static str>,
}

const NO_LOOKS: &str = "the two runs have no look in common";

/// The object `check` of a scenario.
pub(crate) fn row(check: &ToleranceCheck) -> CheckRow {
    let force = check.force.as_ref();
    let missing = force.is_none().then_some(NO_LOOKS);
    CheckRow {
        tolerance: check.tolerance,
        status: check.stopped.map_or("completed", |stopped| stopped.word),
        look_s: check.look_s,
        force_difference_n: force.map(|force| force.difference),
        force_difference_n_reason: missing,
        part_of_peak: force.map(Difference::part_of_peak),
        part_of_peak_reason: missing,
        signals: check.signals.iter().map(signal).collect(),
        events: check.metrics.iter().map(event).collect(),
    }
}

fn signal(found: &Difference) -> SignalRow {
    SignalRow {
        name: found.name,
        difference: found.difference,
        time_s: found.time_s,
        peak: found.peak,
        part_of_peak: found.part_of_peak(),
    }
}

fn event(found: &MetricDifferences) -> EventCheckAnswer {
    let metric = |(name, measured): &(&'static str, Measured)| MetricCheckAnswer {
        name,
        difference: measured.ok(),
        difference_reason: measured.err(),
    };
    EventCheckAnswer {
        kind: found.window.cause.word(),
        time_s: found.window.start_s,
        metrics: found.differences.iter().map(metric).collect(),
    }
}

/// What a check found, a sentence each.
pub(crate) fn sentences(check: &ToleranceCheck) -> Vec<String> {
    let tolerance = significant(check.tolerance, 3);
    let mut told = Vec::new();
    if let Some(stopped) = check.stopped {
        told.push(format!(
            "the check at the tolerance {tolerance} ended at {} s: later nothing is compared",
            significant(stopped.time_s, 6)
        ));
    }
    let Some(force) = &check.force else { return told };
    told.push(format!(
        "checked at the tolerance {tolerance}: the force differs by {} N at {} s, {} of its peak{}",
        significant(force.difference, 2),
        significant(force.time_s, 6),
        significant(force.part_of_peak(), 2),
        of_disturbance(check)
    ));
    if check.is_doubtful() {
        told.push(
            "that is more than a thousandth: take its numbers for no more exact than this, or state a smaller `simulation.tolerance`; \
             where that does not bring them closer, they hang on what no solver tells"
                .to_string(),
        );
    }
    told
}

/// The difference of the disturbance peak, where the load moves.
fn of_disturbance(check: &ToleranceCheck) -> String {
    let found = check.metrics.iter().find_map(|metrics| metrics.of("disturbance_peak_n")?.ok());
    found.map_or(String::new(), |found| format!("; the disturbance peak by {} N", significant(found, 2)))
}
