//! Requirements that no loop can satisfy, found before any search, each with the key that states
//! it.

use phea_qft::design::{DesignProblem, Finding, FindingSeverity, diagnose};
use phea_qft::family::Family;
use phea_qft::specification::ClosedLoop;

use crate::design::design_problem;
pub use crate::impossible_steps::{ImpossibleStep, ImpossibleSteps, SlowStep, StillTimes};
use crate::impossible_steps::{few_plants, impossible_steps};
use crate::project::Project;
use crate::robust::RobustProblem;
use crate::setup::Setup;
use crate::specification::{SpecificationError, closed_loops, crossed_limits};

/// A requirement that no linear loop can satisfy.
#[derive(Clone, Debug)]
pub enum Impossibility {
    /// Limits that cross.
    CrossedLimits(SpecificationError),
    /// A required step.
    Step(ImpossibleStep),
    /// Requirement that a few plants forbid, with the path of its key.
    Plants(String, Finding),
}

/// Requirements that no linear loop can satisfy: limits that cross; requirements that a few plants
/// forbid (the nominal one, some corners, some members), whatever the controller; times shorter
/// than a delay; and required steps that the rig does not reach. Each holds for every controller
/// and prefilter; an empty list does not mean that a controller exists. Without specifications or
/// without a robust problem, only crossed limits are found.
///
/// # Errors
/// [`SpecificationError`] for a limit that is absent or not a function of frequency.
pub fn impossibilities(
    setup: &Setup<'_>,
    problem: Option<&RobustProblem>,
) -> Result<Vec<Impossibility>, SpecificationError> {
    let project = setup.project;
    let crossed = crossed_limits(project)?.into_iter();
    let mut found: Vec<Impossibility> = crossed.map(Impossibility::CrossedLimits).collect();
    if let Some(problem) = problem.filter(|_| !project.specifications.is_empty()) {
        found.extend(impossible_steps(setup, problem).into_iter().map(Impossibility::Step));
        found.extend(of_plants(setup, problem, few_plants(&problem.family)));
    }
    Ok(found)
}

/// Requirements that a few plants forbid.
fn of_plants(setup: &Setup<'_>, problem: &RobustProblem, family: Family) -> Vec<Impossibility> {
    let few = DesignProblem { family, ..design_problem(setup, problem) };
    let is_new = |finding: &Finding| {
        finding.severity() == FindingSeverity::Impossible && !matches!(finding, Finding::CrossedLimits { .. })
    };
    let findings = diagnose(&few).into_iter().filter(is_new);
    findings.map(|finding| Impossibility::Plants(path(setup.project, &finding), finding)).collect()
}

/// Path of the key of the first specification that a finding concerns.
fn path(project: &Project, finding: &Finding) -> String {
    match finding.specifications().first() {
        Some(first) => key_of(project, *first).unwrap_or_else(|| "controller.quantization".to_string()),
        None if matches!(finding, Finding::DelayMargin { .. }) => "design.minimum_delay_margin".to_string(),
        None => "uncertainty".to_string(),
    }
}

/// Key of a limit on a closed loop, by its index.
fn key_of(project: &Project, index: usize) -> Option<String> {
    let (number, closed_loop, _) = closed_loops(project).nth(index)?;
    let key = if closed_loop == ClosedLoop::Tracking { "lower" } else { "limit" };
    Some(format!("specification[{}].{key}", number - 1))
}
