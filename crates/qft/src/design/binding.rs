//! What the specification costs: which limit binds the loop at each frequency.

use super::result::{BindingLimit, Conflict};
use crate::verification::{Audit, PlantPoint, WorstCase};
use phea_dynamics::order::sort_by_number;

/// For each design frequency the specification that leaves the loop the least room, in order of
/// increasing frequency.
pub(super) fn binding_limits(audit: &Audit) -> Vec<BindingLimit> {
    let mut limits: Vec<BindingLimit> = Vec::new();
    for (specification, finding) in audit.specifications.iter().enumerate() {
        for case in &finding.at_design_frequencies {
            let found = limits.iter_mut().find(|limit| limit.frequency_rad_per_s == case.frequency_rad_per_s);
            match found {
                Some(limit) if limit.margin_db <= case.margin_db => {}
                Some(limit) => *limit = binding(specification, case),
                None => limits.push(binding(specification, case)),
            }
        }
    }
    sort_by_number(&mut limits, |limit| limit.frequency_rad_per_s);
    limits
}

fn binding(specification: usize, case: &WorstCase) -> BindingLimit {
    BindingLimit {
        specification,
        frequency_rad_per_s: case.frequency_rad_per_s,
        plant: case.plant.clone(),
        margin_db: case.margin_db,
    }
}

/// The worst violations of the family and of the additional plants.
pub(super) fn all_conflicts(audit: &Audit, beside: &[Audit], tolerance_db: f64) -> Vec<Conflict> {
    let mut found = conflicts(audit, tolerance_db);
    for (index, audit) in beside.iter().enumerate() {
        let plant = PlantPoint::Beside(index);
        found.extend(
            conflicts(audit, tolerance_db).into_iter().map(|one| Conflict { plant: plant.clone(), ..one }),
        );
    }
    sort_by_number(&mut found, |conflict| conflict.margin_db);
    found
}

/// The worst violation of every violated specification, the worst first: the limits that conflict
/// where the common relaxation is as small as possible.
fn conflicts(audit: &Audit, tolerance_db: f64) -> Vec<Conflict> {
    let mut found: Vec<Conflict> = Vec::new();
    for (specification, finding) in audit.specifications.iter().enumerate() {
        let bands = finding.violations.iter().map(|band| &band.worst);
        for case in bands.filter(|case| case.margin_db < -tolerance_db) {
            found.push(Conflict {
                specification,
                frequency_rad_per_s: case.frequency_rad_per_s,
                plant: case.plant.clone(),
                margin_db: case.margin_db,
            });
        }
    }
    sort_by_number(&mut found, |conflict| conflict.margin_db);
    found
}
