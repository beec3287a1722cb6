//! A check, in an answer and for people.

use super::{Difference, Metric, ToleranceCheck};
use crate::answer::{Object, significant};
use crate::quantity::{FORCE, MotionKind, QuantityName, Units};
use crate::simulate::{RunStatus, unmeasured_words};

/// The object `check` of a scenario.
pub(crate) fn row(check: &ToleranceCheck, motion: MotionKind) -> Object {
    let force = check.force.as_ref().ok_or("the two runs have no sample in common");
    Object::new()
        .with("tolerance", check.tolerance)
        .with("status", check.stopped.map_or(RunStatus::Completed, |stopped| stopped.status).key())
        .with("look_s", check.look_s)
        .told(
            QuantityName::OfMotion(["force_difference", "torque_difference"], &FORCE),
            force.map(|force| force.difference),
        )
        .told("part_of_peak", force.map(Difference::part_of_peak))
        .each("signals", &check.signals, |found| {
            Object::new()
                .with("name", found.signal.quantity())
                .with("difference", found.difference)
                .with("time_s", found.time_s)
                .with("peak", found.peak)
                .with("part_of_peak", found.part_of_peak())
        })
        .each("events", &check.metrics, |found| {
            Object::new().with("kind", found.window.cause.word()).with("time_s", found.window.start_s).each(
                "metrics",
                Metric::ALL,
                |metric| {
                    Object::new().with("name", metric.quantity()).told(
                        "difference",
                        found.differences[metric].map_err(|why| unmeasured_words(why, motion)),
                    )
                },
            )
        })
}

/// The findings of a check, a sentence each.
pub(crate) fn sentences(check: &ToleranceCheck, units: Units) -> Vec<String> {
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
        "checked at the tolerance {tolerance}: the {} differs by {} at {} s, {} of its peak{}",
        units.motion.words().force,
        units.force.text(force.difference, 2),
        significant(force.time_s, 6),
        significant(force.part_of_peak(), 2),
        of_disturbance(check, units)
    ));
    if check.is_doubtful() {
        told.push(
            "that is more than a thousandth: take its numbers for no more exact than this, or state a smaller `simulation.tolerance`; \
             where that does not bring them closer, they depend on details that no solver resolves"
                .to_string(),
        );
    }
    told
}

/// The difference of the disturbance peak, where the load moves.
fn of_disturbance(check: &ToleranceCheck, units: Units) -> String {
    let found = check.metrics.iter().find_map(|metrics| metrics.differences[Metric::DisturbancePeak].ok());
    found.map_or(String::new(), |found| format!("; the disturbance peak by {}", units.force.text(found, 2)))
}
