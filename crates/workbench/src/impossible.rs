//! Requirements that no loop can satisfy, in sentences, each with what would satisfy it.

use phea_engineering::design::Explanation;
use phea_engineering::impossible::{
    Impossibilities, Impossibility, ImpossibleStep, ImpossibleSteps, SlowStep, StillTimes,
};
use phea_qft::design::Finding;

use crate::caveat::{beyond_reach, force};
use crate::explanation::explanation_sentence;
use crate::project::LateError;
use crate::quantity::{DisplayUnit, Units, significant};
use crate::robust::RobustProblem;
use crate::specification;

/// The requirements of a project that no loop can satisfy, each at its key.
pub(crate) fn late_of_all(impossible: &Impossibilities, units: &Units) -> Vec<LateError> {
    let Impossibilities { found, problem } = impossible;
    let of = |one: &Impossibility| match one {
        Impossibility::CrossedLimits(error) => Some(specification::late(error)),
        Impossibility::Step(step) => Some(late(step, units)),
        Impossibility::Plants(path, finding) => Some(of_plants(path, finding, problem.as_ref()?)),
    };
    found.iter().filter_map(of).collect()
}

/// The steps that end a design, each at its key.
pub(crate) fn late_of_steps(impossible: &ImpossibleSteps) -> Vec<LateError> {
    impossible.steps.iter().map(|step| late(step, &impossible.units)).collect()
}

/// A step that no controller makes on the rig.
fn late(step: &ImpossibleStep, units: &Units) -> LateError {
    let (message, help) = match step {
        ImpossibleStep::BeforeForceMoves { number, key, settling, still } => {
            before_force_moves((*number, key), *settling, still)
        }
        ImpossibleStep::BeyondReach(beyond) => beyond_reach(beyond, units),
        ImpossibleStep::TooSlow(slow) => too_slow(slow, units),
    };
    LateError { path: step.path(), message, help }
}

fn milliseconds(time_s: f64) -> String {
    DisplayUnit::MILLISECOND.text(time_s, 3)
}

fn before_force_moves((number, key): (usize, &str), settling: f64, still: &StillTimes) -> (String, String) {
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
            "[[specification]] {number}, `{key}`: no step settles in {}, since the force does not move before {total} ({})",
            milliseconds(settling),
            words.join(", ")
        ),
        format!("require more than {total}, or shorten {shortened}"),
    )
}

fn too_slow(slow: &SlowStep, units: &Units) -> (String, String) {
    let plant = match slow.plant.0.is_empty() {
        true => "the nominal plant".to_string(),
        false => slow.plant.words(),
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

/// What a few plants forbid, with the first of them.
fn of_plants(path: &str, finding: &Finding, problem: &RobustProblem) -> LateError {
    let explanation = Explanation::of(finding, problem);
    let plant = explanation.plants.first().map(|plant| problem.names.text(plant));
    let plant = plant.filter(|text| !text.is_empty()).map_or(String::new(), |text| format!(" ({text})"));
    let message = format!("{}{plant}", explanation_sentence(&explanation));
    LateError { path: path.to_string(), message, help: cure(problem, finding) }
}

/// What would satisfy a requirement that a finding forbids.
fn cure(problem: &RobustProblem, finding: &Finding) -> String {
    match finding {
        Finding::SumBelowOne { frequency_rad_per_s, sensitivity, complementary, .. } => {
            let at = significant(*frequency_rad_per_s, 3);
            format!(
                "at {at} rad/s raise the limit of {} until |S| may be {}, or that of {} until |T| may be {}, or end the `band` of one of them before",
                problem.stated(sensitivity.specification),
                significant(1.0 - complementary.limit, 3),
                problem.stated(complementary.specification),
                significant(1.0 - sensitivity.limit, 3)
            )
        }
        Finding::DelayMargin { greatest_s, .. } => {
            format!("require less than {} ms", significant(1e3 * greatest_s, 3))
        }
        Finding::GainSign { .. } => "narrow the ranges so that all plants have one sign".to_string(),
        Finding::PoleOnTheAxis { frequency_rad_per_s, .. } => {
            format!("allow |T| = 1 at {} rad/s, or end `band` before", significant(*frequency_rad_per_s, 3))
        }
        Finding::ZeroOnTheAxis { frequency_rad_per_s, .. } => {
            format!("allow |S| = 1 at {} rad/s, or begin `band` beyond", significant(*frequency_rad_per_s, 3))
        }
        _ => match finding.relaxation_db() {
            Some(relaxation_db) => format!(
                "raise its limits by more than {} dB, or end their `band` before",
                significant(relaxation_db, 3)
            ),
            None => "another plant: less dead time, or slower poles and faster zeros in the right half plane"
                .to_string(),
        },
    }
}
