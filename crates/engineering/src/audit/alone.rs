//! The rig itself, where the family does not contain it.

use phea_dynamics::watch::unwatched;
use phea_qft::verification::Verdict;

use super::asked;
use crate::caveat::Caveat;
use crate::project::Project;
use crate::quantity::significant;
use crate::rig::{ParameterOrigin, ResolvedParameter};
use crate::robust::RobustProblem;
use crate::setup::Setup;

/// Part of a derived value by which it may lie outside of bounds that are printed to three digits.
const ROUNDED: f64 = 0.01;

/// The project without its uncertainty, and what of it the box does not contain. `None` where the
/// box contains the rig, or nothing is known of a rig.
pub fn outside(setup: &Setup<'_>) -> Option<(Project, String)> {
    let (project, rig) = (setup.project, setup.rig().ok()?);
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
    let alone = || Project { uncertainty: Vec::new(), family: None, operating_point, ..project.clone() };
    (!outside.is_empty()).then(|| (alone(), outside.join("; ")))
}

/// What the loop of a problem does to the rig itself, where the family does not contain it.
pub(super) fn caveat(problem: &RobustProblem) -> Option<Caveat> {
    let (alone, beyond) = problem.rig_outside.as_ref()?;
    let audit = phea_qft::audit::audit(&asked(problem, alone), &mut unwatched).ok()?;
    let violated: Vec<String> = audit
        .specifications
        .iter()
        .enumerate()
        .filter(|(_, finding)| finding.verdict == Verdict::Violated)
        .map(|(index, _)| format!("{} {}", index + 1, problem.name_of(index)))
        .collect();
    let does = match (audit.verdict, audit.stability.verdict) {
        (Verdict::Met, _) => "the loop with it is stable and satisfies every specification".to_string(),
        (_, Verdict::Violated) => "the loop with it is unstable".to_string(),
        (Verdict::Violated, _) => format!("the loop with it violates {}", violated.join(", ")),
        (Verdict::NotProven, _) => "nothing is proven of the loop with it".to_string(),
    };
    Some(Caveat {
        sentence: format!("the family does not contain the rig as it is derived ({beyond}): {does}"),
        unproven: audit.verdict != Verdict::Met,
    })
}
