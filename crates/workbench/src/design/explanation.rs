//! What can be said of a problem whatever a search finds: impossibilities, and what will be hard.

use phea_qft::design::{Finding, Severity};
use phea_qft::verification::PlantPoint;

/// One sentence on what a controller cannot do, or only hardly.
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// For an engineer.
    pub sentence: String,
    /// Whether no controller whatever keeps to the specifications because of it.
    pub is_impossible: bool,
    /// rad/s, where it happens.
    pub frequency_rad_per_s: Option<f64>,
    /// The plants that it concerns.
    pub plants: Vec<PlantPoint>,
    /// Indices of the specifications that it concerns.
    pub specifications: Vec<usize>,
    /// A common relaxation of all limits below which nothing helps, dB.
    pub relaxation_db: Option<f64>,
}

/// In the order of the findings, impossibilities first.
pub(super) fn explanations(findings: &[Finding]) -> Vec<Explanation> {
    findings.iter().map(explanation).collect()
}

fn explanation(finding: &Finding) -> Explanation {
    Explanation {
        sentence: finding.to_string(),
        is_impossible: finding.severity() == Severity::Impossible,
        frequency_rad_per_s: frequency(finding),
        plants: plants(finding),
        specifications: finding.specifications(),
        relaxation_db: finding.relaxation_db(),
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
        Finding::Contradiction { parties, .. } => parties
            .iter()
            .flat_map(|party| [Some(party.plant.clone()), party.other.clone()])
            .flatten()
            .collect(),
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

#[cfg(test)]
mod tests {
    use phea_qft::design::diagnose;

    use super::*;
    use crate::design::design_problem;
    use crate::robust::robust_problem;
    use crate::source::Memory;

    const CONTRADICTORY: &str = include_str!("../../../../examples/qft/mistakes/contradictory_bounds.toml");

    #[test]
    fn two_limits_that_no_loop_keeps_together_are_explained() {
        let source = Memory::default().with("mistake.toml", CONTRADICTORY);
        let project = crate::project::read(&source, "mistake.toml", &[], &[]).unwrap().project;
        let given = robust_problem(&source, &project).unwrap();
        let found = explanations(&diagnose(&design_problem(&project, &given).unwrap()));
        let impossible = found.iter().find(|one| one.is_impossible && one.specifications == [0, 1]).unwrap();
        // |S| <= w/|jw + 30| up to 10 rad/s and |T| <= 5/|jw + 5| from 8 rad/s: both hold there alone
        assert!((8.0..=10.0).contains(&impossible.frequency_rad_per_s.unwrap()), "{impossible:?}");
        assert!(impossible.relaxation_db.unwrap() > 0.0 && impossible.sentence.contains("rad/s"));
        assert!(!impossible.plants.is_empty());
        assert!(found.is_sorted_by_key(|one| !one.is_impossible));
    }
}
