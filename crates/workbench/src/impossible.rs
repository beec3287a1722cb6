//! Requirements that no loop can satisfy, in sentences, each with the change that would satisfy it.

use phea_engineering::design::Explanation;
use phea_engineering::impossible::Impossibility;
use phea_qft::design::Finding;

use crate::explanation::explanation_sentence;
use crate::impossible_steps::late_of_step;
use crate::plant_names::plant_text;
use crate::project::LateError;
use crate::quantity::{Units, significant};
use crate::robust::RobustProblem;
use crate::specification::{self, stated};

/// A requirement of a project that no loop can satisfy, at its key; `None` for a requirement that
/// plants forbid if there is no robust problem.
pub(crate) fn late_of(
    one: &Impossibility,
    problem: Option<&RobustProblem>,
    units: &Units,
) -> Option<LateError> {
    Some(match one {
        Impossibility::CrossedLimits(error) => specification::late(error),
        Impossibility::Step(step) => late_of_step(step, units),
        Impossibility::Plants(path, finding) => of_plants(path, finding, problem?),
    })
}

/// Requirement that a few plants forbid, with the first of them.
fn of_plants(path: &str, finding: &Finding, problem: &RobustProblem) -> LateError {
    let explanation = Explanation::of(finding, problem);
    let plant = explanation.plants.first().map(|plant| plant_text(&problem.names, plant));
    let plant = plant.filter(|text| !text.is_empty()).map_or(String::new(), |text| format!(" ({text})"));
    let message = format!("{}{plant}", explanation_sentence(&explanation));
    LateError { path: path.to_string(), message, help: remedy(problem, finding) }
}

/// Remedy for a requirement that a finding forbids.
fn remedy(problem: &RobustProblem, finding: &Finding) -> String {
    match finding {
        Finding::SumBelowOne { frequency_rad_per_s, sensitivity, complementary, .. } => {
            let at = significant(*frequency_rad_per_s, 3);
            format!(
                "at {at} rad/s raise the limit of {} until |S| may be {}, or that of {} until |T| may be {}, or end the `band` of one of them before",
                stated(problem.named(sensitivity.specification)),
                significant(1.0 - complementary.limit, 3),
                stated(problem.named(complementary.specification)),
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
