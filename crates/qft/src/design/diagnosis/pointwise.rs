//! Limits of performance at a single frequency, plant by plant.

use phea_dynamics::frequency::decibels;
use phea_dynamics::portable;

use super::candidate::PlantWithinLoop;
use super::ceiling::{Ceiling, Ceilings, demanded};
use super::finding::{Finding, SharedLimit};
use super::interpolation::least_relaxation_db;
use crate::closed_loop::Compensation;
use crate::specification::{ClosedLoop, Specification};

/// Least deficit of two limits that is reported, dB: each verdict tolerates 0.001 dB.
const TOLERANCE_DB: f64 = 0.002;
const RELAXATION_MAXIMUM_DB: f64 = 400.0;

/// Tracking limits that cross, each specification where it is worst, over its design frequencies
/// and those of the cells.
pub(super) fn crossed(specifications: &[Specification], frequencies: &[f64]) -> Vec<Finding> {
    let of = |(index, specification): (usize, &Specification)| {
        if !specification.requirement.is_tracking() {
            return None;
        }
        let own = specification.frequencies_rad_per_s.iter().chain(&specification.band_rad_per_s);
        let ratio = |frequency: &f64| Some((*frequency, demanded(specification, *frequency)?));
        let all = own.chain(frequencies).filter(|frequency| frequency.is_finite()).filter_map(ratio);
        let (frequency, ratio) = all.min_by(|a, b| a.1.total_cmp(&b.1))?;
        let (lower, upper) = specification.requirement.limits();
        let relaxation_db = -decibels(ratio) / 2.0;
        (relaxation_db > TOLERANCE_DB / 2.0).then_some(Finding::CrossedLimits {
            specification: index,
            frequency_rad_per_s: frequency,
            lower: lower.and_then(|lower| lower.magnitude(frequency))?,
            upper: upper.magnitude(frequency)?,
            relaxation_db,
        })
    };
    specifications.iter().enumerate().filter_map(of).collect()
}

/// The frequency and plant for which the limits of S and T have the least sum, if it is below 1.
pub(super) fn sum_below_one(ceilings: &Ceilings, candidates: &[PlantWithinLoop]) -> Option<Finding> {
    let sum = |ceiling: Ceiling| ceiling.sensitivity.limit + ceiling.complementary.limit;
    let all = (0..candidates.len()).flat_map(|candidate| {
        ceilings.of(candidate, 1.0).enumerate().map(move |(place, ceiling)| (candidate, place, sum(ceiling)))
    });
    let (candidate, place, least) = all.min_by(|a, b| a.2.total_cmp(&b.2))?;
    if decibels(least) >= -TOLERANCE_DB {
        return None;
    }
    let enough = |relaxation_db: f64| {
        let factor = portable::pow(10.0, relaxation_db / 20.0);
        ceilings.at_node(place, candidate, factor).is_some_and(|ceiling| sum(ceiling) >= 1.0)
    };
    let ceiling = ceilings.at_node(place, candidate, 1.0)?;
    let limit = |fraction: super::ceiling::RoomFraction| {
        Some(SharedLimit { specification: fraction.specification?, limit: fraction.limit })
    };
    Some(Finding::SumBelowOne {
        frequency_rad_per_s: *ceilings.boundary.frequencies.get(place)?,
        plant: candidates.get(candidate)?.point.clone(),
        sensitivity: limit(ceiling.sensitivity)?,
        complementary: limit(ceiling.complementary)?,
        relaxation_db: least_relaxation_db(RELAXATION_MAXIMUM_DB, enough),
    })
}

/// Limits that a pole or zero of a plant on the axis contradicts, each specification once.
pub(super) fn on_the_axis(
    specifications: &[Specification],
    candidates: &[PlantWithinLoop],
    compensation: &Compensation,
) -> Vec<Finding> {
    let highest = compensation.highest_frequency_rad_per_s();
    let sampled = compensation.sample_time_s().is_some();
    let mut found: Vec<Finding> = Vec::new();
    let mut add = |finding: Finding| {
        let known = found.iter().any(|other| other.specifications() == finding.specifications());
        if !known {
            found.push(finding);
        }
    };
    for candidate in candidates {
        for (specification, demand) in specifications.iter().enumerate() {
            for &frequency in candidate.axis_poles.iter().filter(|pole| **pole < highest) {
                let ClosedLoop::RobustStability = demand.requirement.closed_loop() else { continue };
                let Some(limit) = demanded(demand, frequency).filter(|limit| below_one(*limit)) else {
                    continue;
                };
                let complementary = SharedLimit { specification, limit };
                let plant = candidate.point.clone();
                add(Finding::PoleOnTheAxis { frequency_rad_per_s: frequency, plant, complementary });
            }
            // sampling preserves only the zero of a plant without static gain
            for &frequency in candidate.axis_zeros.iter().filter(|zero| !sampled || **zero == 0.0) {
                let Some(limit) = forbidden_by_zero(demand, candidate, frequency) else { continue };
                let limit = SharedLimit { specification, limit };
                let plant = candidate.point.clone();
                add(Finding::ZeroOnTheAxis { frequency_rad_per_s: frequency, plant, limit });
            }
        }
    }
    found
}

fn below_one(limit: f64) -> bool {
    decibels(limit) < -TOLERANCE_DB
}

/// The limit that S = 1 and F P G S = 0 violate.
fn forbidden_by_zero(
    specification: &Specification,
    candidate: &PlantWithinLoop,
    frequency: f64,
) -> Option<f64> {
    let limit = demanded(specification, frequency)?;
    match specification.requirement.closed_loop() {
        ClosedLoop::Sensitivity => Some(limit).filter(|limit| below_one(*limit)),
        ClosedLoop::LoadMotion => {
            let motion = portable::magnitude(candidate.member.response(frequency)?.load_motion);
            Some(limit / motion).filter(|limit| below_one(*limit))
        }
        ClosedLoop::Tracking => {
            specification.requirement.limits().0?.magnitude(frequency).filter(|lower| *lower > 0.0)
        }
        _ => None,
    }
}

/// Tracking limits that exclude 1 at zero frequency.
pub(super) fn static_gains(specifications: &[Specification]) -> Vec<Finding> {
    let of = |(index, specification): (usize, &Specification)| {
        let (Some(lower), upper) = specification.requirement.limits() else { return None };
        demanded(specification, 0.0)?;
        let (lower, upper) = (lower.magnitude(0.0)?, upper.magnitude(0.0)?);
        let excluded = decibels(lower) > TOLERANCE_DB || decibels(upper) < -TOLERANCE_DB;
        excluded.then_some(Finding::StaticGain { specification: index, lower, upper })
    };
    specifications.iter().enumerate().filter_map(of).collect()
}
