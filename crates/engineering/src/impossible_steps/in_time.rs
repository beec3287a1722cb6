//! Requirements in time that are shorter than a delay.

use phea_hydraulics::line::{Conduit, StiffeningMember};

use crate::audit::LoopDeadTime;
use crate::project::LateError;
use crate::quantity::DisplayUnit;
use crate::robust::RobustProblem;
use crate::setup::Setup;
use crate::simulate::TimeRequirement;

/// The times that pass before the force moves, s, each with its name: the dead time between
/// reference and force, and on the rig the run of a wave through the shorter line.
fn still(setup: &Setup<'_>, problem: &RobustProblem) -> [(f64, &'static str); 4] {
    let dead_time = LoopDeadTime::of(problem);
    [
        (problem.compensation.delay_s(), "the delay of the controller"),
        (dead_time.controller_s, "the dead time of its transfer function"),
        (dead_time.plant_s[1], "the dead time of the plant"),
        (wave_s(setup).unwrap_or(0.0), "the time of a wave through the shorter line"),
    ]
}

/// The sum of the times that pass before the force moves, s.
pub(super) fn still_s(setup: &Setup<'_>, problem: &RobustProblem) -> f64 {
    still(setup, problem).iter().map(|(time_s, _)| time_s).sum()
}

/// No step settles before the force has moved.
pub(super) fn findings(setup: &Setup<'_>, problem: &RobustProblem) -> Vec<LateError> {
    let (parts, total_s) = (still(setup, problem), still_s(setup, problem));
    let words = parts.iter().filter(|(time_s, _)| *time_s > 0.0);
    let words: Vec<String> = words.map(|(time_s, name)| format!("{} {name}", text(*time_s))).collect();
    let of = |requirement: &TimeRequirement| {
        let settling_s = requirement.wish.settling_time_s.filter(|time_s| *time_s <= total_s)?;
        let key = if requirement.limits.is_some() { "lower.settling_time" } else { "settling_time" };
        Some(LateError {
            path: format!("specification[{}].{key}", requirement.number - 1),
            message: format!(
                "[[specification]] {}, `{key}`: no step settles in {}, since the force does not move before {} ({})",
                requirement.number,
                text(settling_s),
                text(total_s),
                words.join(", ")
            ),
            help: format!("require more than {}, or shorten {}", text(total_s), shortened(&parts)),
        })
    };
    problem.in_time.iter().filter_map(of).collect()
}

/// The times that can be shortened: `the line`, `the delay`.
fn shortened(parts: &[(f64, &str); 4]) -> &'static str {
    let [.., (wave_s, _)] = parts;
    match (parts[..3].iter().any(|(time_s, _)| *time_s > 0.0), *wave_s > 0.0) {
        (false, true) => "the line",
        (true, true) => "the delay or the line",
        (_, false) => "the delay",
    }
}

fn text(time_s: f64) -> String {
    DisplayUnit::MILLISECOND.text(time_s, 3)
}

/// The time of a wave through the shorter line, s; `None` without lines, and where the plant's dead
/// time has it already.
fn wave_s(setup: &Setup<'_>) -> Option<f64> {
    let rig = setup.rig().ok()?;
    let components = rig.actuator.components();
    let delay = |line| {
        Conduit::of_line(line, &components.fluid, rig.actuator.mean_pressure(), StiffeningMember::Nominal)
    };
    let delays = [&components.line_a, &components.line_b].into_iter().map(|line| delay(line).ok());
    let delays: Option<Vec<f64>> = delays.map(|conduit| conduit.map(|one| one.delay())).collect();
    delays?.into_iter().reduce(f64::min)
}
