//! What was not looked at, in words.

use super::PlantPoint;
use super::finding::Joining;
use crate::specification::Limit;

pub(super) fn remarks(joining: &Joining, judged: bool, unresolved: Option<(f64, usize)>) -> Vec<String> {
    let mut remarks = Vec::new();
    let [from, to] = joining.specification.band_rad_per_s;
    let highest = joining.evaluator.compensation.highest_frequency_rad_per_s();
    if to > highest {
        remarks.push(format!(
            "a sampled loop has no frequencies above pi/T = {highest} rad/s: the band ends there"
        ));
    }
    for criterion in joining.part.criteria().filter_map(|index| joining.evaluator.criteria.get(index)) {
        let [low, high] = criterion.band;
        let cut = low > from || high < to.min(highest);
        if matches!(criterion.limit, Limit::Table(_)) && cut {
            remarks
                .push(format!("the table reaches from {low} to {high} rad/s: nothing is demanded beyond it"));
        }
    }
    if !judged && unresolved.is_none() {
        remarks.push("nothing is demanded within the band".to_string());
    }
    for frequency in &joining.specification.frequencies_rad_per_s {
        if *frequency < from || *frequency > to.min(highest) {
            remarks.push(format!("the design frequency {frequency} rad/s lies outside of the band"));
        }
    }
    if joining.part.spread {
        remarks.push(
            "judged by its spread, without a prefilter: the plants named have the greatest and the least |T|"
                .to_string(),
        );
    }
    let measured = joining.plants.iter().any(|plant| matches!(plant.point, PlantPoint::Measured(_)));
    if measured {
        remarks.push(
            "measured plants: between two measured frequencies the response is interpolated".to_string(),
        );
    }
    if let Some((frequency, plant)) = unresolved {
        let plant = match joining.plants.get(plant).map(|plant| (&plant.point, &plant.member)) {
            Some((_, None)) => "plant that cannot be sampled".to_string(),
            Some((PlantPoint::Measured(index), _)) => format!("measurement {index}"),
            _ => "plant".to_string(),
        };
        remarks.push(format!("at {frequency} rad/s a {plant} has no response that could be judged"));
    }
    if let Some(frequency) = joining.undefined {
        remarks.push(format!("inside the box there is a plant that cannot be judged at {frequency} rad/s"));
    }
    remarks
}
