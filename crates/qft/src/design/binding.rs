//! Cost of the specification: the limit that binds the loop at each frequency.

use super::Objective;
use super::problem::DesignOptions;
use crate::verification::{Audit, PlantPoint, SpecificationMargin};
use phea_dynamics::order::sort_by_number;

/// Slack below which a limit is active, dB.
pub const BINDING_DB: f64 = 0.05;

/// Relative difference of two frequencies that belong to one minimum of a plant.
const SAME_FREQUENCY: f64 = 0.05;

/// The active limits, at the design frequencies and where each specification is worst over its band
/// or as bad, in order of increasing frequency: those within [`BINDING_DB`] of the limit less the
/// reserve of the design, and those beyond. A design for the best worst margin is bound by the
/// limits within that tolerance of its margin.
pub(super) fn binding_limits(audit: &Audit, options: &DesignOptions) -> Vec<SpecificationMargin> {
    let mut cases: Vec<(f64, SpecificationMargin)> = Vec::new();
    for finding in &audit.specifications {
        let own = finding.at_design_frequencies.iter().chain(&finding.worst).map(|case| (case, 0.0));
        for (case, apart) in own.chain(finding.as_bad.iter().map(|case| (case, SAME_FREQUENCY))) {
            let is_known = cases.iter().any(|(_, one)| {
                let [known, own] = [one.frequency_rad_per_s, case.frequency_rad_per_s];
                let is_near = (known - own).abs() <= apart * own && one.plant == case.plant;
                one.specification == case.specification && (known == own || is_near)
            });
            let reserve_db = finding.requirement.reserve_at_db(options.reserve_db, case.frequency_rad_per_s);
            // a spread involves two limits
            let limits = if case.other.is_some() { 2.0 } else { 1.0 };
            if !is_known {
                cases.push((case.margin_db - limits * reserve_db, case.clone()));
            }
        }
    }
    let least_db = match options.objective {
        Objective::BestWorstMargin => cases.iter().map(|(room_db, _)| *room_db).fold(f64::INFINITY, f64::min),
        Objective::LeastHighFrequencyGain | Objective::LeastBandwidth => 0.0,
    };
    let is_bound = |room_db: f64| room_db <= least_db.max(0.0) + BINDING_DB;
    let mut limits: Vec<SpecificationMargin> =
        cases.into_iter().filter(|(room_db, _)| is_bound(*room_db)).map(|(_, limit)| limit).collect();
    sort_by_number(&mut limits, |limit| limit.frequency_rad_per_s);
    limits
}

/// The worst violations of the family and of the additional plants.
pub(super) fn all_conflicts(
    audit: &Audit,
    additional_audits: &[Audit],
    tolerance_db: f64,
) -> Vec<SpecificationMargin> {
    let mut found = conflicts(audit, tolerance_db);
    for (index, audit) in additional_audits.iter().enumerate() {
        let of_plant = |one| SpecificationMargin { plant: PlantPoint::Additional(index), other: None, ..one };
        found.extend(conflicts(audit, tolerance_db).into_iter().map(of_plant));
    }
    sort_by_number(&mut found, |conflict| conflict.margin_db);
    found
}

/// The worst violation of every violated specification, the worst first: the limits that conflict
/// where the common relaxation is as small as possible.
fn conflicts(audit: &Audit, tolerance_db: f64) -> Vec<SpecificationMargin> {
    let bands = audit.specifications.iter().flat_map(|finding| &finding.violations);
    let violated = bands.map(|band| &band.worst).filter(|case| case.margin_db < -tolerance_db);
    let mut found: Vec<SpecificationMargin> = violated.cloned().collect();
    sort_by_number(&mut found, |conflict| conflict.margin_db);
    found
}
