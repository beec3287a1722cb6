//! The rig itself, where the family does not contain it.

use phea_dynamics::watch::{Stopped, Watch};
use phea_qft::verification::{Audit, Verdict};

use super::asked;
use crate::caveat::Caveat;
use crate::project::Project;
use crate::quantity::significant;
use crate::rig::{ParameterOrigin, ResolvedParameter, Rig};
use crate::robust::RobustProblem;
use crate::setup::Setup;

/// Relative amount by which a derived value may lie outside bounds that are printed to three
/// digits.
const ROUNDED: f64 = 0.01;

/// The project without its uncertainty, and the parameters that the box does not contain. `None`
/// where the box contains the rig, or there is no rig.
pub fn outside(setup: &Setup<'_>) -> Option<(Project, String)> {
    outside_of(setup.project, setup.rig().ok()?)
}

/// The same of a project and its rig.
pub(crate) fn outside_of(project: &Project, rig: &Rig) -> Option<(Project, String)> {
    let beyond = |one: &&ResolvedParameter| {
        let slack = ROUNDED * one.derived.abs();
        one.origin == ParameterOrigin::Uncertainty
            && one
                .bounds
                .is_some_and(|[least, most]| one.derived < least - slack || one.derived > most + slack)
    };
    let words = |name: &str, value: f64, bounds: [f64; 2]| {
        let [least, most] = bounds.map(|bound| significant(bound, 4));
        format!("{name} is {}, the box has {least} to {most}", significant(value, 4))
    };
    let derived = rig.parameters.iter().filter(beyond);
    let mut outside: Vec<String> =
        derived.map(|one| words(one.name, one.derived, one.bounds.unwrap_or_default())).collect();
    outside.extend(project.uncertainty.iter().filter_map(|one| {
        let declared =
            project.number(&one.name).filter(|value| *value < one.minimum || *value > one.maximum)?;
        Some(words(&one.name, declared, [one.minimum, one.maximum]))
    }));
    let operating_point = project.resolved_operating_point();
    let alone = || Project { operating_point, ..project.without_uncertainty() };
    (!outside.is_empty()).then(|| (alone(), outside.join("; ")))
}

/// The audit of the rig itself in the loop of a problem, where the family does not contain it.
pub(crate) fn caveat(problem: &RobustProblem, watch: Watch<'_>) -> Result<Option<Caveat>, Stopped> {
    let Some((alone, beyond)) = &problem.rig_outside else { return Ok(None) };
    let audit = phea_qft::audit::audit(&asked(problem, alone), watch)?;
    Ok(Some(of_rig(beyond, does(problem, &audit), audit.verdict != Verdict::Met)))
}

/// The result where the watch stopped it: unknown.
pub(crate) fn unexamined(problem: &RobustProblem) -> Option<Caveat> {
    let (_, beyond) = problem.rig_outside.as_ref()?;
    Some(of_rig(beyond, NOTHING_PROVEN.to_string(), true))
}

const NOTHING_PROVEN: &str = "nothing is proven of the loop with it";

fn of_rig(beyond: &str, does: String, unproven: bool) -> Caveat {
    let sentence = format!("the family does not contain the rig as it is derived ({beyond}): {does}");
    Caveat { sentence, unproven }
}

/// The audit of the loop with the rig.
fn does(problem: &RobustProblem, audit: &Audit) -> String {
    let violated: Vec<String> = audit
        .specifications
        .iter()
        .enumerate()
        .filter(|(_, finding)| finding.verdict == Verdict::Violated)
        .map(|(index, _)| format!("{} {}", index + 1, problem.name_of(index)))
        .collect();
    match (audit.verdict, audit.stability.verdict) {
        (Verdict::Met, _) => "the loop with it is stable and satisfies every specification".to_string(),
        (_, Verdict::Violated) => "the loop with it is unstable".to_string(),
        (Verdict::Violated, _) => format!("the loop with it violates {}", violated.join(", ")),
        (Verdict::NotProven, _) => NOTHING_PROVEN.to_string(),
    }
}
