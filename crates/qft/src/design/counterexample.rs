//! What an audit teaches the search: plants and frequencies that it had not looked at.

use crate::specification::Requirement;
use crate::verification::{Audit, PlantPoint, TrackingJudgement, Verdict, WorstCase};

/// A plant, or the pair of a spread, and the frequency at which it breaks a limit, where there is one.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Counterexample {
    pub(super) plants: Vec<PlantPoint>,
    pub(super) frequency_rad_per_s: Option<f64>,
}

/// The plants that break a limit by more than `tolerance_db` (both limits of a spread by that much), each once with each of its
/// frequencies; of an unstable family the plant that is unstable.
pub(super) fn counterexamples(
    audit: &Audit,
    tolerance_db: f64,
    tracking: TrackingJudgement,
) -> Vec<Counterexample> {
    let mut found: Vec<Counterexample> = Vec::new();
    if audit.stability.verdict == Verdict::Violated {
        let plants = vec![audit.stability.plant.clone()];
        found.push(Counterexample { plants, frequency_rad_per_s: None });
    }
    for finding in &audit.specifications {
        let is_spread = tracking == TrackingJudgement::Spread
            && matches!(finding.requirement, Requirement::Tracking { .. });
        let tolerance = if is_spread { 2.0 * tolerance_db } else { tolerance_db };
        let bands = finding.violations.iter().map(|band| &band.worst);
        let cases = finding.worst.iter().chain(&finding.interior).chain(bands);
        let cases = cases.chain(&finding.at_design_frequencies);
        for case in cases.filter(|case| case.margin_db < -tolerance) {
            let plants = std::iter::once(&case.plant).chain(&case.other).cloned().collect();
            let example = Counterexample { plants, frequency_rad_per_s: inside(case) };
            if !found.contains(&example) {
                found.push(example);
            }
        }
    }
    found
}

fn inside(case: &WorstCase) -> Option<f64> {
    Some(case.frequency_rad_per_s).filter(|frequency| *frequency > 0.0 && frequency.is_finite())
}

/// The least margin of all specifications, dB; `None` for a family that is not known to be stable.
pub(super) fn worst_margin_db(audit: &Audit) -> Option<f64> {
    let stable = audit.stability.verdict == Verdict::Met;
    let margins = audit.specifications.iter().filter_map(|finding| finding.worst.as_ref());
    let worst = margins.map(|worst| worst.margin_db).fold(f64::INFINITY, f64::min);
    stable.then_some(worst)
}
