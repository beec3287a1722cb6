//! What is known about a problem whatever a search finds: impossibilities, and what will be hard.

mod words;

use phea_qft::design::{Finding, FindingSeverity};
use phea_qft::verification::{PlantPoint, SpecificationMargin};

/// One sentence on what is impossible or hard for a controller.
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// For an engineer.
    pub sentence: String,
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

impl Explanation {
    /// A finding of the diagnosis in words, which name each specification by its index.
    pub fn of(finding: &Finding, name_of: &dyn Fn(usize) -> String) -> Explanation {
        Explanation {
            sentence: words::FindingWords { finding, name_of }.to_string(),
            is_impossible: finding.severity() == FindingSeverity::Impossible,
            frequency_rad_per_s: frequency(finding),
            plants: plants(finding),
            specifications: finding.specifications(),
            relaxation_db: finding.relaxation_db(),
        }
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
