//! What was not looked at, in words.

use super::PlantPoint;
use super::finding::{Case, Joining};
use crate::family::Family;
use crate::specification::Limit;

/// To four significant digits, as a reader wants it.
pub(crate) fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

pub(super) fn remarks(
    joining: &Joining,
    worst: Option<&Case>,
    unresolved: Option<(f64, usize)>,
) -> Vec<String> {
    let mut remarks = Vec::new();
    let [from, to] = joining.specification.band_rad_per_s;
    let highest = joining.evaluator.compensation.highest_frequency_rad_per_s();
    if to > highest {
        remarks.push(format!(
            "a sampled loop has no frequencies above pi/T = {} rad/s: the band ends there",
            rounded(highest)
        ));
    }
    for criterion in joining.part.criteria().filter_map(|index| joining.evaluator.criteria.get(index)) {
        let [low, high] = criterion.band;
        let cut = low > from || high < to.min(highest);
        if matches!(criterion.limit, Limit::Table(_)) && cut {
            let [low, high] = [rounded(low), rounded(high)];
            remarks
                .push(format!("the table reaches from {low} to {high} rad/s: nothing is demanded beyond it"));
        }
    }
    if worst.is_none() && unresolved.is_none() {
        remarks.push("nothing is demanded within the band".to_string());
    }
    for frequency in &joining.specification.frequencies_rad_per_s {
        if *frequency < from || *frequency > to.min(highest) {
            remarks.push(format!("the design frequency {frequency} rad/s lies outside of the band"));
        }
    }
    if joining.part.spread {
        remarks.push(spread(joining, worst));
    }
    let measured = joining.plants.iter().any(|plant| matches!(plant.point, PlantPoint::Measured(_)));
    if measured {
        remarks.push(
            "measured plants: between two frequencies of the measurement the response is interpolated"
                .to_string(),
        );
    }
    if let Some((frequency, plant)) = unresolved {
        remarks.push(without_response(joining, frequency, plant));
    }
    if let Some(frequency) = joining.undefined {
        let frequency = rounded(frequency);
        remarks.push(format!("inside the box there is a plant that cannot be judged at {frequency} rad/s"));
    }
    remarks
}

/// Which plants make the spread.
fn spread(joining: &Joining, worst: Option<&Case>) -> String {
    let judged = "judged by its spread, without a prefilter";
    match worst.map(|worst| (worst.frequency, worst.points.as_slice())) {
        Some((f64::INFINITY, [greatest, least])) => format!(
            "{judged}: towards infinite frequency {} has the greatest |T|, {} the least",
            named(joining.family, greatest),
            named(joining.family, least)
        ),
        Some((frequency, [greatest, least])) => format!(
            "{judged}: at {} rad/s {} has the greatest |T|, {} the least",
            rounded(frequency),
            named(joining.family, greatest),
            named(joining.family, least)
        ),
        _ => judged.to_string(),
    }
}

/// A plant by its parameters, or its number.
fn named(family: &Family, point: &PlantPoint) -> String {
    match (family, point) {
        (Family::Uncertain(family), PlantPoint::Parameters(values)) => {
            let parameters = family.plant().parameters().iter().zip(values);
            let parameters: Vec<String> = parameters
                .map(|(parameter, value)| format!("{} = {}", parameter.name, rounded(*value)))
                .collect();
            format!("the plant with {}", parameters.join(", "))
        }
        (Family::Measured(family), PlantPoint::Measured(index)) => {
            let name = family.plants().get(*index).map_or("", |plant| plant.name.as_str());
            format!("the measured plant {name}")
        }
        _ => "the plant".to_string(),
    }
}

/// Why a plant could not be judged at a frequency.
fn without_response(joining: &Joining, frequency: f64, index: usize) -> String {
    let beyond = |range: &[f64; 2]| frequency < range[0] || frequency > range[1];
    if let (Family::Measured(_), Some([from, to])) = (joining.family, measured_by_all(joining).filter(beyond))
    {
        let [from, to] = [rounded(from), rounded(to)];
        return format!("the measurements reach from {from} to {to} rad/s: nothing is known beyond");
    }
    let frequency = rounded(frequency);
    match joining.plants.get(index) {
        Some(plant) if plant.member.is_none() => {
            format!(
                "at {frequency} rad/s a plant that cannot be sampled has no response that could be judged"
            )
        }
        Some(plant) => {
            let plant = named(joining.family, &plant.point);
            format!("at {frequency} rad/s {plant} has no response that could be judged")
        }
        None => format!("at {frequency} rad/s a plant has no response that could be judged"),
    }
}

/// Between which frequencies every plant was measured, rad/s.
fn measured_by_all(joining: &Joining) -> Option<[f64; 2]> {
    let ranges = joining.plants.iter().filter_map(|plant| plant.features.range);
    ranges.reduce(|one, other| [one[0].max(other[0]), one[1].min(other[1])])
}
