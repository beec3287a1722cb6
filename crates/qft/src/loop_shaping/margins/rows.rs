//! The plants of a column that may become its worst one nearby.

use num_complex::Complex64;
use phea_dynamics::portable;

use super::super::samples::FrequencyColumn;
use super::super::structure::DECIBELS_PER_NEPER;
use super::{ColumnLoop, Demand, LimitedSide, extremes};

/// Largest change of ln G for which a margin may be needed.
const REACH: f64 = 0.5;
/// Plants whose magnitude squared is further from the worst one's than by this factor, 12 dB, are
/// not considered.
const WINDOW: f64 = 16.0;
/// Plants that are kept of one column and demand.
const PLANTS_MAXIMUM: usize = 4;

/// One margin: `d margin/dx = -(20/ln 10) Re(c d ln G/dx)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MarginCandidate {
    pub(crate) margin_db: f64,
    /// c; for a lower limit its negative, for a spread the difference of the c of both plants.
    pub(crate) sensitivity: Complex64,
    /// Index of the plant, of the one with the greatest magnitude in a spread.
    pub(crate) plant: usize,
    /// The plant with the least magnitude, in a spread.
    pub(crate) other: Option<usize>,
}

/// The worst margin of the column, and those that may become the worst within a change of ln G of
/// [`REACH`]: after the worst, each time the plant whose c lies farthest from those already chosen,
/// relative to its distance.
pub(crate) fn candidates(
    demand: &Demand,
    column: &FrequencyColumn,
    around: &ColumnLoop,
    feedback: Complex64,
) -> Vec<MarginCandidate> {
    let squares: Vec<f64> =
        (0..column.plants.len()).map(|place| demand.squared(column, around, place)).collect();
    let [least, greatest] = extremes(squares.iter().copied());
    let half_decibels = |squared: f64| DECIBELS_PER_NEPER * 0.5 * portable::ln(squared);
    let of = |place: usize, margin_db: f64, sign: f64| {
        let open = column.loop_at(place) * feedback;
        let coefficient = demand.feedback_power() - open / (1.0 + open);
        MarginCandidate {
            margin_db,
            sensitivity: coefficient * sign,
            plant: column.plants[place],
            other: None,
        }
    };
    let below = |allowed: f64| {
        let high = squares.iter().enumerate().filter(|(_, square)| **square * WINDOW >= greatest);
        prominent(high.map(|(place, square)| of(place, half_decibels(allowed / square), 1.0)).collect())
    };
    let above = |allowed: f64| {
        let low = squares.iter().enumerate().filter(|(_, square)| **square <= least * WINDOW);
        prominent(low.map(|(place, square)| of(place, half_decibels(square / allowed), -1.0)).collect())
    };
    let allowed = demand.allowed;
    match demand.limited {
        LimitedSide::FromBelow => above(allowed),
        LimitedSide::Spread => {
            let (tops, bottoms) = (below(1.0), above(1.0));
            let allowed_db = half_decibels(allowed);
            let mut pairs: Vec<MarginCandidate> = Vec::new();
            for top in &tops {
                pairs.extend(bottoms.iter().map(|bottom| MarginCandidate {
                    margin_db: allowed_db + top.margin_db + bottom.margin_db,
                    sensitivity: top.sensitivity + bottom.sensitivity,
                    plant: top.plant,
                    other: Some(bottom.plant),
                }));
            }
            prominent(pairs)
        }
        LimitedSide::FromAbove => below(allowed),
    }
}

/// The worst first; margins that are NaN are left out.
fn prominent(mut all: Vec<MarginCandidate>) -> Vec<MarginCandidate> {
    all.retain(|candidate| candidate.margin_db.is_finite() && candidate.sensitivity.is_finite());
    let by_margin =
        |one: &&MarginCandidate, other: &&MarginCandidate| one.margin_db.total_cmp(&other.margin_db);
    let Some(&worst) = all.iter().min_by(by_margin) else { return all };
    let mut chosen = vec![worst];
    // of each, the square of the distance from the nearest that is chosen
    let mut distances = vec![f64::INFINITY; all.len()];
    let mut newest = worst;
    while chosen.len() < PLANTS_MAXIMUM {
        for (distance, candidate) in distances.iter_mut().zip(&all) {
            *distance = distance.min((candidate.sensitivity - newest.sensitivity).norm_sqr());
        }
        let threats = distances.iter().zip(&all).map(|(distance, candidate)| {
            let reach = DECIBELS_PER_NEPER * REACH * distance.sqrt();
            (reach - (candidate.margin_db - worst.margin_db), candidate)
        });
        let next = threats.max_by(|one, other| one.0.total_cmp(&other.0).then(by_margin(&one.1, &other.1)));
        match next {
            Some((threat, candidate)) if threat > 0.0 => newest = *candidate,
            _ => break,
        }
        chosen.push(newest);
    }
    chosen
}
