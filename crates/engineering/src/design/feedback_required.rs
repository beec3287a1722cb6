//! Search for specifications that require feedback.
//!
//! ```text
//! largest |P| / least |P| <= upper/lower      at every design frequency: F suffices for the limits, with any loop however slow
//! ```

use phea_dynamics::closed_loop::ClosedLoop;
use phea_dynamics::portable;
use phea_qft::family::Family;
use phea_qft::specification::Specification;

use super::{ExplainedFact, Explanation};
use crate::robust::RobustProblem;

/// An explanation if the specifications are limits on tracking that the plants satisfy without a
/// loop, and nothing limits a disturbance; `None` if something requires feedback.
pub(super) fn feedback_not_required(given: &RobustProblem) -> Option<Explanation> {
    let own = given.specifications.len() - given.design_limits.len();
    let own = given.specifications.get(..own)?;
    let rejects = |one: &Specification| {
        matches!(
            one.requirement.closed_loop(),
            ClosedLoop::Sensitivity | ClosedLoop::PlantInputDisturbance | ClosedLoop::LoadMotion
        )
    };
    let tracking: Vec<usize> = own
        .iter()
        .enumerate()
        .filter(|(_, one)| one.requirement.is_tracking())
        .map(|(index, _)| index)
        .collect();
    if tracking.is_empty() || own.iter().any(rejects) {
        return None;
    }
    let Family::Uncertain(family) = &given.family else { return None };
    let spread = |frequency: f64| {
        let sizes = family.members().iter().filter_map(|values| family.plant().response(values, frequency));
        let (least, most) = sizes
            .map(portable::magnitude)
            .fold((f64::INFINITY, 0.0), |(least, most), size| (f64::min(least, size), f64::max(most, size)));
        most / least
    };
    let keeps = |one: &Specification| {
        let (lower, upper) = one.requirement.limits();
        one.frequencies_rad_per_s.iter().all(|&frequency| {
            let room = upper.magnitude(frequency).zip(lower.and_then(|limit| limit.magnitude(frequency)));
            room.is_some_and(|(upper, lower)| spread(frequency) <= upper / lower)
        })
    };
    tracking.iter().all(|&index| keeps(&own[index])).then(|| Explanation {
        fact: ExplainedFact::FeedbackNotRequired,
        limits: vec![],
        is_impossible: false,
        frequency_rad_per_s: None,
        plants: vec![],
        specifications: tracking.clone(),
        relaxation_db: None,
    })
}
