//! Requirements that no loop can satisfy, found before any search, each with the key that states
//! it and what would satisfy it.

use phea_qft::design::{DesignProblem, Finding, FindingSeverity, diagnose};
use phea_qft::family::Family;
use phea_qft::specification::ClosedLoop;

use crate::design::{Explanation, design_problem};
use crate::impossible_steps::{few_plants, impossible_steps};
use crate::project::{LateError, Project};
use crate::quantity::significant;
use crate::robust::{RobustProblem, robust_problem};
use crate::setup::Setup;
use crate::source::Source;
use crate::specification::{SpecificationError, closed_loops, crossed_limits};

/// A requirement that no loop can satisfy.
#[derive(Clone, Debug, PartialEq)]
pub enum Impossibility {
    /// A limit or a step, at the key that states it.
    Stated(LateError),
    /// A requirement that a few plants forbid.
    OfPlants {
        /// The key that states it.
        path: String,
        /// The impossibility.
        explanation: Box<Explanation>,
        /// The first plant that it concerns; empty where that has no parameters.
        plant: String,
        /// A change that would satisfy it.
        cure: String,
    },
}

/// Requirements that no linear loop can satisfy: limits that cross; what a few plants forbid
/// (the nominal one, some corners, some members), whatever the controller; times shorter than a
/// delay; and required steps that the rig does not reach. Each holds for every controller and
/// prefilter; an empty list does not mean that a controller exists. Where there is no robust
/// problem, only crossed limits are found.
///
/// # Errors
/// [`SpecificationError`] for a limit that is absent or not a function of frequency.
pub fn impossibilities(
    source: &dyn Source,
    setup: &Setup<'_>,
) -> Result<Vec<Impossibility>, SpecificationError> {
    let project = setup.project;
    let crossed = crossed_limits(project)?;
    let mut found: Vec<Impossibility> = crossed.iter().map(|one| Impossibility::Stated(one.at())).collect();
    if project.specifications.is_empty() {
        return Ok(found);
    }
    let Ok(problem) = robust_problem(source, setup) else { return Ok(found) };
    found.extend(impossible_steps(setup, &problem).into_iter().map(Impossibility::Stated));
    found.extend(of_plants(setup, &problem, few_plants(&problem.family)));
    Ok(found)
}

/// What a few plants forbid.
fn of_plants(setup: &Setup<'_>, problem: &RobustProblem, family: Family) -> Vec<Impossibility> {
    let few = DesignProblem { family, ..design_problem(setup, problem) };
    let is_new = |finding: &Finding| {
        finding.severity() == FindingSeverity::Impossible && !matches!(finding, Finding::CrossedLimits { .. })
    };
    let findings = diagnose(&few);
    findings.iter().filter(|finding| is_new(finding)).map(|one| stated(setup.project, problem, one)).collect()
}

/// A finding at the key of the first specification that it concerns, with the plant.
fn stated(project: &Project, problem: &RobustProblem, finding: &Finding) -> Impossibility {
    let explanation = Explanation::of(finding, problem);
    let plant = explanation.plants.first().map(|plant| problem.names.text(plant));
    let path = match explanation.specifications.first() {
        Some(first) => key_of(project, *first).unwrap_or_else(|| "controller.quantization".to_string()),
        None if matches!(finding, Finding::DelayMargin { .. }) => "design.minimum_delay_margin".to_string(),
        None => "uncertainty".to_string(),
    };
    let (plant, cure) = (plant.unwrap_or_default(), cure(problem, finding));
    Impossibility::OfPlants { path, explanation: Box::new(explanation), plant, cure }
}

/// The key of a limit on a closed loop, by its index.
fn key_of(project: &Project, index: usize) -> Option<String> {
    let (number, closed_loop, _) = closed_loops(project).nth(index)?;
    let key = if closed_loop == ClosedLoop::Tracking { "lower" } else { "limit" };
    Some(format!("specification[{}].{key}", number - 1))
}

/// What would satisfy it.
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
            Some(relaxation_db) => {
                format!(
                    "raise its limits by more than {} dB, or end their `band` before",
                    significant(relaxation_db, 3)
                )
            }
            None => "another plant: less dead time, or slower poles and faster zeros in the right half plane"
                .to_string(),
        },
    }
}
