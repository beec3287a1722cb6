//! Margins of the samples: the requirements at a frequency, and the distance by which the plants
//! satisfy them.
//!
//! ```text
//! X = A G^a/(1 + B G),  B = P H,       margin = 20 log10(limit/|X|)
//! d margin/dx = -(20/ln 10) Re(c d ln G/dx),    c = a - B G/(1 + B G)
//! ```
//!
//! A margin thus depends on two real numbers of its plant, the parts of c. The search for a worst
//! plant compares squares of magnitudes.

mod crossover;
mod prominent;
mod rows;

use num_complex::Complex64;
use phea_dynamics::closed_loop::PlantPath;
use phea_dynamics::portable;

use super::samples::FrequencyColumn;
use super::structure::DECIBELS_PER_NEPER;
use crate::specification::{ClosedLoop, Specification, fraction_kept};
use crate::verification::TrackingJudgement;

pub(super) use crossover::{AboveColumns, ColumnDependence, DelayMargins, bandwidth, delay_margins};
pub(super) use prominent::MarginCandidate;
pub(super) use rows::candidates;

/// Requirement on the plants at one frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Demand {
    pub(super) specification: usize,
    pub(super) closed_loop: ClosedLoop,
    limited: LimitedSide,
    /// The square of the limit or, for a spread, of the ratio of both limits.
    allowed: f64,
    rate: f64,
}

/// Side on which a closed loop is limited.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LimitedSide {
    FromAbove,
    FromBelow,
    /// Both sides: the ratio of the greatest magnitude to the least, without a prefilter.
    Spread,
}

/// Controller and prefilter at one frequency, and |1/(1+L)|^2 of the plants there.
#[derive(Clone, Debug, Default)]
pub(super) struct ColumnLoop {
    feedback_squared: f64,
    prefilter_squared: f64,
    sensitivity_squared: Vec<f64>,
}

/// Tightening of the limits, and scaling of a margin between two of them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Keeping {
    /// Tightening of every limit, dB; reduced to a fraction if two limits are close together, see
    /// [`fraction_kept`].
    pub(super) reserve_db: f64,
    /// True if a margin counts as a fraction of the room between two limits, if that is less than 1
    /// dB. Otherwise limits that meet, as those of tracking do at zero frequency, would leave no
    /// margin to increase.
    pub(super) fraction_of_room: bool,
}

/// Smallest room that is used, dB.
const ROOM_LEAST_DB: f64 = 1e-6;

/// Requirements of the specifications at a frequency, for a loop that is defined up to the highest
/// one.
pub(super) fn demands(
    specifications: &[Specification],
    tracking: TrackingJudgement,
    Keeping { reserve_db, fraction_of_room }: Keeping,
    [frequency, highest_frequency]: [f64; 2],
) -> Vec<Demand> {
    let mut demands = Vec::new();
    for (index, specification) in specifications.iter().enumerate() {
        let [from, to] = specification.band_rad_per_s;
        if !(from <= frequency && frequency <= to.min(highest_frequency)) {
            continue;
        }
        let (lower, upper) = specification.requirement.limits();
        let square = |magnitude: f64| magnitude * magnitude;
        let lower = lower.and_then(|limit| limit.magnitude(frequency)).map(square);
        let upper = upper.magnitude(frequency).map(square);
        let ratio = upper.zip(lower).map(|(upper, lower)| upper / lower);
        // the square of a magnitude changes by a tenth of a decade per dB
        let room_db = ratio.map(|ratio| 10.0 * portable::log10(ratio));
        let inwards = portable::pow(10.0, -0.1 * reserve_db * fraction_kept(reserve_db, room_db));
        let room_db = room_db.map_or(1.0, |room_db| room_db.clamp(0.0, 1.0));
        let [lower, upper] = [lower.map(|lower| lower / inwards), upper.map(|upper| upper * inwards)];
        let spread = specification.requirement.is_tracking() && tracking == TrackingJudgement::Spread;
        let limits = match spread {
            true => [
                (LimitedSide::Spread, ratio.map(|ratio| ratio * inwards * inwards)),
                (LimitedSide::Spread, None),
            ],
            false => [(LimitedSide::FromAbove, upper), (LimitedSide::FromBelow, lower)],
        };
        demands.extend(limits.into_iter().filter_map(|(limited, allowed)| {
            let unit = if limited == LimitedSide::Spread { 2.0 } else { 1.0 };
            let rate = if fraction_of_room { unit * room_db.max(ROOM_LEAST_DB) } else { unit };
            let closed_loop = specification.requirement.closed_loop();
            Some(Demand { specification: index, closed_loop, limited, allowed: allowed?, rate })
        }));
    }
    if demands.is_empty() && !specifications.is_empty() && frequency <= highest_frequency {
        demands.push(Demand::RESERVE);
    }
    demands
}

impl Demand {
    /// Requirement where no specification applies: |1/(1+L)| stays below 20 dB, so that no search
    /// for the least objective follows the stability limit beyond the bands.
    const RESERVE: Demand = Demand {
        specification: usize::MAX,
        closed_loop: ClosedLoop::Sensitivity,
        limited: LimitedSide::FromAbove,
        allowed: 100.0,
        rate: 1.0,
    };

    /// True if it belongs to no specification.
    pub(super) fn is_reserve(&self) -> bool {
        self.specification == usize::MAX
    }

    /// Number that exceeds the requirements of any column.
    pub(super) const PER_COLUMN: usize = 64;

    /// Increase of the margin per dB of relaxation of every limit; see
    /// [`Keeping::fraction_of_room`].
    pub(super) fn rate(&self) -> f64 {
        self.rate
    }

    /// True if F is a factor of the limited magnitude: it cancels in a spread.
    fn has_prefilter(&self) -> bool {
        self.closed_loop.has_prefilter() && self.limited != LimitedSide::Spread
    }

    /// The power of F in the limited magnitude, with the sign of the limit: 1 for an upper one, -1
    /// for a lower one.
    pub(super) fn prefilter_power(&self) -> f64 {
        match self.limited {
            LimitedSide::FromAbove if self.has_prefilter() => 1.0,
            LimitedSide::FromBelow if self.has_prefilter() => -1.0,
            _ => 0.0,
        }
    }

    /// Power a of G in the limited magnitude.
    fn feedback_power(&self) -> f64 {
        if self.closed_loop.has_feedback() { 1.0 } else { 0.0 }
    }

    /// The square of the factors G and F of the limited magnitude.
    fn compensator_squared(&self, around: &ColumnLoop) -> f64 {
        match (self.closed_loop.has_feedback(), self.has_prefilter()) {
            (true, true) => around.feedback_squared * around.prefilter_squared,
            (true, false) => around.feedback_squared,
            (false, _) => 1.0,
        }
    }

    /// The square of A of each plant; `None` if it is 1.
    fn paths_squared<'c>(&self, column: &'c FrequencyColumn) -> Option<&'c [f64]> {
        match self.closed_loop.plant_path() {
            PlantPath::PlantAndSensor => Some(&column.loop_squared),
            PlantPath::One => None,
            PlantPath::Plant => Some(&column.plant_squared),
            PlantPath::LoadMotion => Some(&column.load_motion_squared),
        }
    }

    /// The square of the limited magnitude of each plant.
    fn squared(&self, column: &FrequencyColumn, around: &ColumnLoop) -> Vec<f64> {
        let sensitivity = &around.sensitivity_squared;
        let mut squares = match self.paths_squared(column) {
            Some(paths) => products(paths, sensitivity).collect(),
            None => sensitivity.clone(),
        };
        let mut multiply = |factor: f64| squares.iter_mut().for_each(|square| *square *= factor);
        if self.closed_loop.has_feedback() {
            multiply(around.feedback_squared);
        }
        if self.has_prefilter() {
            multiply(around.prefilter_squared);
        }
        squares
    }

    /// The square of the ratio of the worst plant, or pair of plants, of the column to the limit; 0
    /// without plants.
    pub(super) fn worst_excess(&self, column: &FrequencyColumn, around: &ColumnLoop) -> f64 {
        let sensitivity = &around.sensitivity_squared;
        let [least, greatest] = match self.paths_squared(column) {
            Some(paths) => {
                let count = paths.len().min(sensitivity.len());
                let (paths, sensitivity) = (&paths[..count], &sensitivity[..count]);
                extremes(|place| paths[place] * sensitivity[place], count)
            }
            None => extremes(|place| sensitivity[place], sensitivity.len()),
        };
        match self.limited {
            LimitedSide::FromAbove => greatest * self.compensator_squared(around) / self.allowed,
            LimitedSide::FromBelow => self.allowed / (least * self.compensator_squared(around)),
            LimitedSide::Spread => greatest / (least * self.allowed),
        }
    }
}

impl ColumnLoop {
    /// Closes the loops of a column with this G and this F.
    pub(super) fn close(&mut self, column: &FrequencyColumn, feedback: Complex64, prefilter: Complex64) {
        self.feedback_squared = feedback.norm_sqr();
        self.prefilter_squared = prefilter.norm_sqr();
        self.sensitivity_squared.clear();
        let loops = column.loop_re.iter().zip(&column.loop_im);
        self.sensitivity_squared.extend(loops.map(|(re, im)| {
            let (real, imaginary) =
                (1.0 + re * feedback.re - im * feedback.im, re * feedback.im + im * feedback.re);
            1.0 / (real * real + imaginary * imaginary)
        }));
    }
}

fn products<'a>(one: &'a [f64], other: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
    one.iter().zip(other).map(|(one, other)| one * other)
}

/// The least and the greatest; infinity and 0 if there are no values. NaN is ignored. Computed in
/// four lanes, so that comparisons are independent of each other.
fn extremes(values: impl Fn(usize) -> f64, count: usize) -> [f64; 2] {
    const LANES: usize = 4;
    let wider = |[least, greatest]: [f64; 2], [low, high]: [f64; 2]| {
        [if low < least { low } else { least }, if high > greatest { high } else { greatest }]
    };
    let none = [f64::INFINITY, 0.0];
    let mut lanes = [none; LANES];
    let whole = count - count % LANES;
    for first in (0..whole).step_by(LANES) {
        for (lane, found) in lanes.iter_mut().enumerate() {
            let value = values(first + lane);
            *found = wider(*found, [value; 2]);
        }
    }
    let rest = (whole..count).map(|place| [values(place); 2]);
    lanes.into_iter().chain(rest).fold(none, wider)
}
