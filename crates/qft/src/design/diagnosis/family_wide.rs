//! Limits of performance for the family as a whole, and for one plant independent of its limits.

use num_complex::Complex64;
use phea_dynamics::order::sort_numbers;

use super::candidate::PlantWithinLoop;
use super::finding::Finding;
use crate::specification::{ClosedLoop, Specification};

/// Relative difference below which poles of two plants count as equal.
const SAME: f64 = 1e-9;

/// The sign of a closed loop's polynomial where it depends on more than the controller.
struct Sign {
    pole: f64,
    positive: bool,
    candidate: usize,
}

/// Finding for plants of different sign.
///
/// The characteristic function D Gd + N Gn e^(-sT) of a stable loop has no zero on [0, inf), and
/// for large s has the sign of Gd times the leading coefficient of D. Where D (or, with integral
/// action, Gd) vanishes it equals N Gn: so the sign of N there over the leading coefficient of D
/// must be the same for all plants.
pub(super) fn gain_signs(specifications: &[Specification], candidates: &[PlantWithinLoop]) -> Vec<Finding> {
    let integral = specifications.iter().any(demands_integral_action);
    let signs: Vec<Sign> = candidates
        .iter()
        .enumerate()
        .flat_map(|(index, candidate)| signs(index, candidate, integral))
        .collect();
    let mut found: Vec<Finding> = Vec::new();
    for (place, sign) in signs.iter().enumerate() {
        let same = |other: &&Sign| (other.pole - sign.pole).abs() <= SAME * sign.pole.abs();
        let opposite =
            signs.iter().skip(place + 1).filter(same).find(|other| other.positive != sign.positive);
        let plants = opposite.and_then(|other| {
            Some([
                candidates.get(sign.candidate)?.point.clone(),
                candidates.get(other.candidate)?.point.clone(),
            ])
        });
        let known = found.iter().any(|finding| {
            matches!(finding, Finding::GainSign { pole_rad_per_s, .. }
                if (pole_rad_per_s - sign.pole).abs() <= SAME * sign.pole.abs())
        });
        if let Some(plants) = plants.filter(|_| !known) {
            found.push(Finding::GainSign { pole_rad_per_s: sign.pole, plants });
        }
    }
    found
}

/// True if S(0) = 0 is required.
fn demands_integral_action(specification: &Specification) -> bool {
    let (requirement, band) = (&specification.requirement, specification.band_rad_per_s);
    requirement.closed_loop() == ClosedLoop::Sensitivity
        && band[0] == 0.0
        && requirement.limits().1.magnitude(0.0) == Some(0.0)
}

fn signs(index: usize, candidate: &PlantWithinLoop, integral: bool) -> Vec<Sign> {
    let Some(command) = &candidate.command else { return Vec::new() };
    let value = |coefficients: &[f64], s: f64| coefficients.iter().fold(0.0, |sum, c| sum * s + c);
    let leading = command.denominator.iter().position(|c| *c != 0.0);
    let Some(leading_coefficient) = leading.and_then(|place| command.denominator.get(place)) else {
        return Vec::new();
    };
    if !is_strictly_proper(candidate) {
        return Vec::new();
    }
    let at_rest = (integral || value(&command.denominator, 0.0) == 0.0).then_some(0.0);
    let poles = candidate.unstable_poles.iter().filter(|pole| pole.im == 0.0).map(|pole| pole.re);
    at_rest
        .into_iter()
        .chain(poles)
        .filter_map(|pole| {
            let sign = value(&command.numerator, pole) / leading_coefficient;
            (sign != 0.0).then_some(Sign { pole, positive: sign > 0.0, candidate: index })
        })
        .collect()
}

/// True if P vanishes for large real s.
fn is_strictly_proper(candidate: &PlantWithinLoop) -> bool {
    let degree = |coefficients: &[f64]| {
        coefficients.iter().position(|c| *c != 0.0).map_or(0, |first| coefficients.len() - first)
    };
    let proper = |command: &phea_dynamics::uncertain_plant::RationalCoefficients<f64>| {
        degree(&command.numerator) < degree(&command.denominator)
    };
    candidate.dead_time_s > 0.0 || candidate.delays > 0 || candidate.command.as_ref().is_some_and(proper)
}

/// Finding: the required delay margin exceeds 2/p, the most that a linear time-invariant controller
/// of a continuous loop can achieve for a plant with the real unstable pole p (Middleton and Miller
/// 2007).
pub(super) fn delay_margin(minimum_s: f64, candidates: &[PlantWithinLoop]) -> Option<Finding> {
    let fastest = candidates.iter().flat_map(|candidate| {
        let real = candidate.unstable_poles.iter().filter(|pole| pole.im == 0.0);
        real.map(move |pole| (pole.re, candidate))
    });
    let (pole, candidate) = fastest.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let greatest_s = 2.0 / pole;
    (minimum_s > greatest_s).then(|| Finding::DelayMargin {
        pole_rad_per_s: pole,
        plant: candidate.point.clone(),
        demanded_s: minimum_s,
        greatest_s,
    })
}

/// Finding: a plant with an odd number of real unstable poles between two of its real zeros in the
/// right half plane, infinity included. No stable controller stabilises it (Youla, Bongiorno and Lu
/// 1974).
pub(super) fn unstable_controller(candidates: &[PlantWithinLoop]) -> Option<Finding> {
    candidates.iter().find_map(|candidate| {
        let real = |roots: &[Complex64]| -> Vec<f64> {
            roots.iter().filter(|root| root.im == 0.0).map(|root| root.re).collect()
        };
        let mut zeros = real(&candidate.zeros);
        zeros.extend(candidate.axis_zeros.iter().filter(|zero| **zero == 0.0));
        if is_strictly_proper(candidate) {
            zeros.push(f64::INFINITY);
        }
        sort_numbers(&mut zeros);
        let poles = real(&candidate.unstable_poles);
        let between = zeros
            .iter()
            .zip(zeros.iter().skip(1))
            .find(|(low, high)| poles.iter().filter(|pole| *low < pole && pole < high).count() % 2 == 1)?;
        Some(Finding::UnstableController {
            plant: candidate.point.clone(),
            between_zeros_rad_per_s: [*between.0, *between.1],
        })
    })
}

/// Design frequencies beyond pi/T, or beyond the range of a measurement.
pub(super) fn out_of_reach(
    specifications: &[Specification],
    candidates: &[PlantWithinLoop],
    highest_rad_per_s: f64,
) -> Vec<Finding> {
    let measured = candidates.iter().filter_map(|candidate| match &candidate.member {
        crate::closed_loop::Member::Measured { plant, .. } => {
            let frequencies = &plant.frequencies_rad_per_s;
            Some(([*frequencies.first()?, *frequencies.last()?], Some(candidate.point.clone())))
        }
        _ => None,
    });
    let reaches: Vec<_> = [([0.0, highest_rad_per_s], None)].into_iter().chain(measured).collect();
    let of = |(specification, demand): (usize, &Specification)| {
        reaches.iter().find_map(|(reach, plant)| {
            let beyond = |frequency: &&f64| **frequency < reach[0] || **frequency > reach[1];
            let first = demand.frequencies_rad_per_s.iter().find(beyond)?;
            Some(Finding::OutOfReach {
                specification,
                frequency_rad_per_s: *first,
                reach_rad_per_s: *reach,
                plant: plant.clone(),
            })
        })
    };
    specifications.iter().enumerate().filter_map(of).collect()
}
