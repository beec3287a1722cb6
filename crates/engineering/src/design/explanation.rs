//! What is known about a problem whatever a search finds: impossibilities, and what will be hard.

use phea_qft::design::{Finding, FindingSeverity};
use phea_qft::verification::{PlantPoint, SpecificationMargin};

use crate::limit_kind::DesignLimitKind;
use crate::robust::RobustProblem;

/// One fact that is impossible or hard for a controller.
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// The fact.
    pub fact: ExplainedFact,
    /// The specifications that it concerns, each by the index that the fact names it by.
    pub limits: Vec<(usize, ExplainedLimit)>,
    /// Whether it means that no controller satisfies the specifications.
    pub is_impossible: bool,
    /// rad/s, where it happens.
    pub frequency_rad_per_s: Option<f64>,
    /// The plants that it concerns.
    pub plants: Vec<PlantPoint>,
    /// Indices of the specifications that it concerns.
    pub specifications: Vec<usize>,
    /// The least common relaxation of all limits that may help, dB.
    pub relaxation_db: Option<f64>,
}

/// A fact about a problem whatever a search finds.
#[derive(Clone, Debug, PartialEq)]
pub enum ExplainedFact {
    /// A finding of the diagnosis.
    Finding(Finding),
    /// Limits on tracking alone, wider than the plants of the family differ: a prefilter without
    /// feedback could keep them.
    NothingAsksForFeedback,
}

/// A specification that an explanation concerns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ExplainedLimit {
    /// A specification of the project, by its name.
    Specification(String),
    /// A limit of what may be built.
    Design(DesignLimitKind),
}

impl Explanation {
    /// A finding of the diagnosis of a problem.
    pub fn of(finding: &Finding, problem: &RobustProblem) -> Explanation {
        let specifications = finding.specifications();
        Explanation {
            limits: specifications.iter().map(|index| (*index, limit(problem, *index))).collect(),
            fact: ExplainedFact::Finding(finding.clone()),
            is_impossible: finding.severity() == FindingSeverity::Impossible,
            frequency_rad_per_s: frequency(finding),
            plants: plants(finding),
            specifications,
            relaxation_db: finding.relaxation_db(),
        }
    }
}

fn limit(problem: &RobustProblem, index: usize) -> ExplainedLimit {
    let own = problem.specifications.len() - problem.design_limits.len();
    match index.checked_sub(own).and_then(|limit| problem.design_limits.get(limit)) {
        Some(kind) => ExplainedLimit::Design(*kind),
        None => ExplainedLimit::Specification(problem.stated(index)),
    }
}

fn frequency(finding: &Finding) -> Option<f64> {
    match finding {
        Finding::CrossedLimits { frequency_rad_per_s, .. }
        | Finding::SumBelowOne { frequency_rad_per_s, .. }
        | Finding::Contradiction { frequency_rad_per_s, .. }
        | Finding::PoleOnTheAxis { frequency_rad_per_s, .. }
        | Finding::ZeroOnTheAxis { frequency_rad_per_s, .. }
        | Finding::OutOfReach { frequency_rad_per_s, .. } => Some(*frequency_rad_per_s),
        Finding::RightHalfPlane { constraint, .. } | Finding::ForcedPeak { constraint, .. } => {
            constraint.crossover_rad_per_s
        }
        Finding::GainSign { .. }
        | Finding::DelayMargin { .. }
        | Finding::UnstableController { .. }
        | Finding::StaticGain { .. } => None,
    }
}

fn plants(finding: &Finding) -> Vec<PlantPoint> {
    match finding {
        Finding::Contradiction { conflicts, .. } => {
            conflicts.iter().flat_map(SpecificationMargin::plants).cloned().collect()
        }
        Finding::GainSign { plants, .. } => plants.to_vec(),
        Finding::SumBelowOne { plant, .. }
        | Finding::PoleOnTheAxis { plant, .. }
        | Finding::ZeroOnTheAxis { plant, .. }
        | Finding::DelayMargin { plant, .. }
        | Finding::UnstableController { plant, .. } => vec![plant.clone()],
        Finding::RightHalfPlane { constraint, .. } | Finding::ForcedPeak { constraint, .. } => {
            vec![constraint.plant.clone()]
        }
        Finding::OutOfReach { plant, .. } => plant.iter().cloned().collect(),
        Finding::CrossedLimits { .. } | Finding::StaticGain { .. } => vec![],
    }
}
