//! The plants of a column that may become its worst one nearby.

use num_complex::Complex64;

use super::super::samples::FrequencyColumn;
use super::prominent::{LimitedPlants, MarginCandidate, half_decibels, prominent, worst_of};
use super::{ColumnLoop, Demand, LimitedSide, extremes};

/// The worst margin of the column, and those that may become the worst nearby: after the worst,
/// successively the plant whose c is farthest from those already chosen, relative to its distance.
pub(crate) fn candidates(
    demand: &Demand,
    column: &FrequencyColumn,
    around: &ColumnLoop,
    feedback: Complex64,
) -> Vec<MarginCandidate> {
    let squares = demand.squared(column, around);
    let [least, greatest] = extremes(|place| squares[place], squares.len());
    let coefficient = |place: usize| {
        let open = column.loop_at(place) * feedback;
        demand.feedback_power() - open / (1.0 + open)
    };
    let side = |is_from_above: bool, allowed: f64| {
        let worst = if is_from_above { greatest } else { least };
        let plants =
            LimitedPlants { plants: &column.plants, squares: &squares, worst, allowed, is_from_above };
        plants.prominent(coefficient)
    };
    match demand.limited {
        LimitedSide::FromAbove => side(true, demand.allowed),
        LimitedSide::FromBelow => side(false, demand.allowed),
        LimitedSide::Spread => {
            let (tops, bottoms) = (side(true, 1.0), side(false, 1.0));
            let allowed_db = half_decibels(demand.allowed);
            let mut pairs: Vec<MarginCandidate> = Vec::new();
            for top in &tops {
                pairs.extend(bottoms.iter().map(|bottom| MarginCandidate {
                    margin_db: allowed_db + top.margin_db + bottom.margin_db,
                    sensitivity: top.sensitivity + bottom.sensitivity,
                    plant: top.plant,
                    other: Some(bottom.plant),
                }));
            }
            worst_of(pairs.iter().copied()).map_or(vec![], |worst| prominent(worst, pairs))
        }
    }
}
