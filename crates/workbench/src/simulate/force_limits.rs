//! Limits on the force at rest that required steps and references exceed, in sentences.

use super::{BeyondReach, ExceededForce, RestLimit, StepEnd};
use crate::quantity::{FORCE, PRESSURE, Units, display};

/// A required step that the rig does not reach, and the remedy.
pub(crate) fn beyond_reach(step: &BeyondReach, units: &Units) -> (String, String) {
    let verb = match step.end {
        StepEnd::Begin => "begins at",
        StepEnd::End => "goes to",
    };
    let (reason, remedy) = exceeded_force(&step.exceeded, units);
    let sentence = format!(
        "[[specification]] {}, `{}`: the step {verb} {}, {reason}",
        step.number,
        step.end.key(),
        force(step.force, units)
    );
    (sentence, remedy)
}

/// A force of the rig's motion.
pub(crate) fn force(value: f64, units: &Units) -> String {
    display(value, units.motion.dimension(&FORCE), 4)
}

/// A limit on the force that is exceeded, and the changes that would raise it.
pub(crate) fn exceeded_force(exceeded: &ExceededForce, units: &Units) -> (String, String) {
    let reached = force(exceeded.greatest, units);
    match exceeded.limit {
        RestLimit::Stall { pressure, force: stalls } => (
            format!(
                "and at a supply of {} the {} stalls at {}: no controller reaches it",
                display(pressure, &PRESSURE, 4),
                units.motion.words().piston,
                force(stalls, units)
            ),
            format!("stay within {reached}, raise the supply pressure, or take a larger actuator"),
        ),
        RestLimit::Relief { opens_at, force: holds } => (
            format!(
                "and the relief valve that opens at {} holds it to {}: no controller reaches it",
                display(opens_at, &PRESSURE, 4),
                force(holds, units)
            ),
            format!("stay within {reached}, or raise `cracking_pressure` in [port_valves]"),
        ),
        RestLimit::Capacity(capacity) => (
            format!("beyond the sensor's `capacity` of {}", force(capacity, units)),
            format!("stay within {reached}, or take a sensor of more capacity"),
        ),
    }
}
