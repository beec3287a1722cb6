//! Limitations of an examination.

use super::criterion::{Criterion, MarginSide};
use super::finding::{FoundMargin, Joining};
use super::scan::ScannedPlant;
use super::{PlantPoint, Remark};
use crate::family::Family;
use crate::specification::Limit;

pub(super) fn remarks(
    joining: &Joining,
    worst: Option<&FoundMargin>,
    unresolved: Option<(f64, usize)>,
    open_certain_db: Option<f64>,
) -> Vec<Remark> {
    let mut remarks = Vec::new();
    let [from, to] = joining.specification.band_rad_per_s;
    let highest = joining.evaluator.compensation.highest_frequency_rad_per_s();
    if to > highest {
        remarks.push(Remark::BandEndsAtNyquist { nyquist_rad_per_s: highest });
    }
    let ends = joining.evaluator.compensation.ends_at_zero();
    let from_below = |criterion: &Criterion| {
        criterion.side == MarginSide::Above && criterion.limit.magnitude(highest).is_some_and(|one| one > 0.0)
    };
    let mut criteria = joining.part.criteria().filter_map(|index| joining.evaluator.criteria.get(index));
    if ends && criteria.any(|criterion| criterion.demands(highest) && from_below(criterion)) {
        remarks.push(Remark::ZeroAtNyquist { nyquist_rad_per_s: highest });
    }
    for criterion in joining.part.criteria().filter_map(|index| joining.evaluator.criteria.get(index)) {
        let [low, high] = criterion.band;
        let cut = low > from || high < to.min(highest);
        if matches!(criterion.limit, Limit::Table(_)) && cut {
            remarks.push(Remark::TableEnds { table_rad_per_s: criterion.band });
        }
    }
    if worst.is_none() && unresolved.is_none() {
        remarks.push(Remark::NothingDemanded);
    }
    for &frequency_rad_per_s in &joining.specification.frequencies_rad_per_s {
        if frequency_rad_per_s < from || frequency_rad_per_s > to.min(highest) {
            remarks.push(Remark::DesignFrequencyOutside { frequency_rad_per_s });
        }
    }
    if joining.part.spread {
        remarks.push(Remark::JudgedBySpread);
    }
    if joining.plants.iter().any(|plant| matches!(plant.point, PlantPoint::Measured(_))) {
        remarks.push(Remark::Interpolated);
    }
    if joining.has_discs() {
        remarks.push(match open_certain_db {
            Some(certain_margin_db) => Remark::OpenWithinDiscs { certain_margin_db },
            None => Remark::WorstWithinDiscs,
        });
    }
    remarks.extend(unresolved.map(|(frequency, plant)| without_response(joining, frequency, plant)));
    remarks
        .extend(joining.undefined.map(|frequency_rad_per_s| Remark::UndefinedInBox { frequency_rad_per_s }));
    remarks
}

/// Remark for a plant that could not be evaluated at a frequency.
fn without_response(joining: &Joining, frequency_rad_per_s: f64, index: usize) -> Remark {
    let beyond = |range: &[f64; 2]| frequency_rad_per_s < range[0] || frequency_rad_per_s > range[1];
    let measured = measured_by_all(joining).filter(beyond);
    if let (Family::Measured(_), Some(measured_rad_per_s)) = (joining.family, measured) {
        return Remark::BeyondMeasurements { measured_rad_per_s };
    }
    match joining.plants.get(index) {
        Some(ScannedPlant { member: None, .. }) => Remark::NotSampled { frequency_rad_per_s },
        plant => Remark::NoResponse { frequency_rad_per_s, plant: plant.map(|plant| plant.point.clone()) },
    }
}

/// Range of frequencies at which every plant was measured, rad/s.
fn measured_by_all(joining: &Joining) -> Option<[f64; 2]> {
    let ranges = joining.plants.iter().filter_map(|plant| plant.features.range);
    ranges.reduce(|one, other| [one[0].max(other[0]), one[1].min(other[1])])
}
