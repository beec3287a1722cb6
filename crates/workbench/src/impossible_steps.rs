//! Required steps that no controller makes on the rig, in sentences, each with the change that
//! would satisfy it.

use phea_engineering::impossible::{ImpossibleStep, ImpossibleSteps, SlowStep, StillTimes};

use crate::plant_names::plant_words;
use crate::project::LateError;
use crate::quantity::{DisplayUnit, MotionKind, Units, significant};
use crate::simulate::{beyond_reach, force};

/// The steps that end a design, each at its key.
pub(crate) fn late_of_steps(impossible: &ImpossibleSteps) -> Vec<LateError> {
    impossible.steps.iter().map(|step| late_of_step(step, &impossible.units)).collect()
}

/// A step that no controller makes on the rig.
pub(crate) fn late_of_step(step: &ImpossibleStep, units: &Units) -> LateError {
    let (message, help) = match step {
        ImpossibleStep::BeforeForceMoves { number, key, settling, still } => {
            before_force_moves((*number, key), *settling, still, units.motion)
        }
        ImpossibleStep::BeyondReach(beyond) => beyond_reach(beyond, units),
        ImpossibleStep::TooSlow(slow) => too_slow(slow, units),
    };
    LateError { path: step.path(), message, help }
}

fn milliseconds(time_s: f64) -> String {
    DisplayUnit::MILLISECOND.text(time_s, 3)
}

fn before_force_moves(
    (number, key): (usize, &str),
    settling: f64,
    still: &StillTimes,
    motion: MotionKind,
) -> (String, String) {
    let force = motion.words().force;
    let parts = [
        (still.controller_delay, "the delay of the controller"),
        (still.controller_dead_time, "the dead time of its transfer function"),
        (still.plant_dead_time, "the dead time of the plant"),
        (still.wave, "the time of a wave through the shorter line"),
    ];
    let words = parts.iter().filter(|(time_s, _)| *time_s > 0.0);
    let words: Vec<String> =
        words.map(|(time_s, name)| format!("{} {name}", milliseconds(*time_s))).collect();
    let total = milliseconds(still.total());
    let has_delay = parts[..3].iter().any(|(time_s, _)| *time_s > 0.0);
    let shortened = match (has_delay, still.wave > 0.0) {
        (false, true) => "the line",
        (true, true) => "the delay or the line",
        (_, false) => "the delay",
    };
    (
        format!(
            "[[specification]] {number}, `{key}`: no step settles in {}, since the {force} does not move before {total} ({})",
            milliseconds(settling),
            words.join(", ")
        ),
        format!("require more than {total}, or shorten {shortened}"),
    )
}

fn too_slow(slow: &SlowStep, units: &Units) -> (String, String) {
    let plant = match slow.plant.0.is_empty() {
        true => "the nominal plant".to_string(),
        false => plant_words(&slow.plant),
    };
    let (of, smaller) = match slow.of_scenario {
        true => ("of a step of a scenario", "smaller steps in the scenarios"),
        false => ("of the step", "a smaller `amplitude`"),
    };
    let lumped = if slow.lumped { " with lumped lines" } else { "" };
    let message = format!(
        "[[specification]] {}, `settling_time`: with at most {} V at the valve the slowest linear plant{lumped} ({plant}) moves by at most {} of the {} {of} in {}",
        slow.number,
        significant(slow.voltage, 3),
        force(slow.reached, units),
        force(slow.size, units),
        milliseconds(slow.settling),
    );
    let help = match slow.is_matter_of_valve() {
        true => format!(
            "require {smaller} or more time, or take a valve with {} times the flow",
            significant(slow.flow_ratio, 2)
        ),
        false => {
            format!("require more time or {smaller}: no larger valve makes up for the time that is missing")
        }
    };
    (message, help)
}
