//! Facts about a problem that hold whatever a search finds: impossibilities and difficulties.

use phea_qft::design::{Finding, FindingSeverity};
use phea_qft::verification::{PlantPoint, SpecificationMargin};

use crate::limit_kind::DesignLimitKind;
use crate::robust::RobustProblem;
use crate::specification::NamedSpecification;

/// One fact that is impossible or hard for a controller.
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// Explained fact.
    pub fact: ExplainedFact,
    /// Specifications that the fact concerns, each by the index with which the fact names it.
    pub limits: Vec<(usize, ExplainedLimit)>,
    /// True if the fact means that no controller satisfies the specifications.
    pub is_impossible: bool,
    /// Frequency of the fact, rad/s.
    pub frequency_rad_per_s: Option<f64>,
    /// Plants that the fact concerns.
    pub plants: Vec<PlantPoint>,
    /// Indices of the specifications that the fact concerns.
    pub specifications: Vec<usize>,
    /// Least common relaxation of all limits that may help, dB.
    pub relaxation_db: Option<f64>,
}

/// A fact about a problem that holds whatever a search finds.
#[derive(Clone, Debug, PartialEq)]
pub enum ExplainedFact {
    /// A finding of the diagnosis.
    Finding(Finding),
    /// The only limits are on tracking, and wider than the spread of the family: a prefilter
    /// without feedback could satisfy them.
    FeedbackNotRequired,
}

/// A specification that an explanation concerns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ExplainedLimit {
    /// A specification of the project.
    Specification(NamedSpecification),
    /// A limit of a deployable controller.
    Design(DesignLimitKind),
}

impl Explanation {
    /// Explanation of a finding of the diagnosis of a problem.
    pub fn of(finding: &Finding, problem: &RobustProblem) -> Explanation {
        let specifications = finding.specifications();
        Explanation {
            limits: specifications
                .iter()
                .filter_map(|index| Some((*index, limit(problem, *index)?)))
                .collect(),
            fact: ExplainedFact::Finding(finding.clone()),
            is_impossible: finding.severity() == FindingSeverity::Impossible,
            frequency_rad_per_s: frequency(finding),
            plants: plants(finding),
            specifications,
            relaxation_db: finding.relaxation_db(),
        }
    }
}

fn limit(problem: &RobustProblem, index: usize) -> Option<ExplainedLimit> {
    let own = problem.specifications.len() - problem.design_limits.len();
    match index.checked_sub(own).and_then(|limit| problem.design_limits.get(limit)) {
        Some(kind) => Some(ExplainedLimit::Design(*kind)),
        None => problem.named(index).map(ExplainedLimit::Specification),
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
