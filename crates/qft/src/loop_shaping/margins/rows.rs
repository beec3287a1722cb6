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
/// Relative difference of two squares whose margins may round to the same number, and a difference
/// of two c that is rounding.
const ROUNDING: f64 = 1e-9;

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
    let squares = demand.squared(column, around);
    let [least, greatest] = extremes(|place| squares[place], squares.len());
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
        let margin_db = |square: f64| half_decibels(allowed / square);
        let is_within = |square: f64| square * WINDOW >= greatest;
        nearby(&squares, greatest, is_within, margin_db, |place| of(place, 0.0, 1.0))
    };
    let above = |allowed: f64| {
        let margin_db = |square: f64| half_decibels(square / allowed);
        let is_within = |square: f64| square <= least * WINDOW;
        nearby(&squares, least, is_within, margin_db, |place| of(place, 0.0, -1.0))
    };
    let allowed = demand.allowed;
    match demand.limited {
        LimitedSide::FromAbove => below(allowed),
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
            worst_of(pairs.iter().copied()).map_or(vec![], |worst| prominent(worst, pairs))
        }
    }
}

fn half_decibels(squared: f64) -> f64 {
    DECIBELS_PER_NEPER * 0.5 * portable::ln(squared)
}

/// The plants of one side that are [`prominent`], by the squares of their magnitudes.
///
/// ```text
/// threat > 0   only for   |c - c_worst| > ln(q) >= 2 (q - 1)/(q + 1)        q: quotient of the squares, 1 or more
/// ```
///
/// so that of most plants no margin is computed.
fn nearby(
    squares: &[f64],
    worst: f64,
    is_within: impl Fn(f64) -> bool,
    margin_db: impl Fn(f64) -> f64,
    without_margin: impl Fn(usize) -> MarginCandidate,
) -> Vec<MarginCandidate> {
    let complete =
        |place: usize, square: f64| MarginCandidate { margin_db: margin_db(square), ..without_margin(place) };
    let all = || squares.iter().copied().enumerate();
    let as_bad = all().filter(|(_, square)| (square - worst).abs() <= ROUNDING * worst);
    let Some(first) = worst_of(as_bad.map(|(place, square)| complete(place, square))) else {
        return vec![];
    };
    let mut threatening = Vec::with_capacity(squares.len());
    for (place, square) in all().filter(|(_, square)| is_within(*square)) {
        let candidate = without_margin(place);
        let least = 2.0 * (square - worst).abs() / (square + worst) - ROUNDING;
        let is_harmless =
            least > 0.0 && (candidate.sensitivity - first.sensitivity).norm_sqr() < least * least;
        if !is_harmless {
            threatening.push(MarginCandidate { margin_db: margin_db(square), ..candidate });
        }
    }
    prominent(first, threatening)
}

impl MarginCandidate {
    fn is_finite(&self) -> bool {
        self.margin_db.is_finite() && self.sensitivity.is_finite()
    }
}

/// The worst one whose margin is a number.
fn worst_of(all: impl Iterator<Item = MarginCandidate>) -> Option<MarginCandidate> {
    all.filter(MarginCandidate::is_finite).min_by(|one, other| one.margin_db.total_cmp(&other.margin_db))
}

/// The worst, then each time the one that threatens most to become it; margins that are NaN are
/// left out.
fn prominent(worst: MarginCandidate, mut others: Vec<MarginCandidate>) -> Vec<MarginCandidate> {
    others.retain(MarginCandidate::is_finite);
    let mut chosen = Vec::with_capacity(PLANTS_MAXIMUM);
    chosen.push(worst);
    // of each, the square of the distance from the nearest that is chosen
    let mut distances = vec![f64::INFINITY; others.len()];
    let mut newest = worst;
    while chosen.len() < PLANTS_MAXIMUM {
        let mut most: Option<(f64, MarginCandidate)> = None;
        for (distance, candidate) in distances.iter_mut().zip(&others) {
            *distance = distance.min((candidate.sensitivity - newest.sensitivity).norm_sqr());
            let reach = DECIBELS_PER_NEPER * REACH * distance.sqrt();
            let threat = reach - (candidate.margin_db - worst.margin_db);
            let is_more = most.is_none_or(|(greatest, other)| {
                let as_great = threat == greatest && candidate.margin_db >= other.margin_db;
                threat > greatest || as_great
            });
            if threat > 0.0 && is_more {
                most = Some((threat, *candidate));
            }
        }
        let Some((_, next)) = most else { break };
        newest = next;
        chosen.push(newest);
    }
    chosen
}
