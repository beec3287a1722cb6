//! Margins of the samples: what is demanded at a frequency, and how far the plants there keep to it.
//!
//! ```text
//! X = A G^a/(1 + B G),  B = P H,       margin = 20 log10(limit/|X|)
//! d margin/dx = -(20/ln 10) Re(c d ln G/dx),    c = a - B G/(1 + B G)
//! ```
//!
//! A margin thus moves with two real numbers of its plant, the parts of c. The search of a worst plant compares squares of magnitudes.

mod crossover;
mod rows;

use num_complex::Complex64;
use phea_dynamics::portable;

use super::samples::Column;
use crate::specification::{Requirement, Specification};
use crate::verification::TrackingJudgement;

pub(super) use crossover::{DelayMargins, bandwidth, delay_margins};
pub(super) use rows::{Candidate, candidates};

/// What is demanded of the plants at one frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Demand {
    pub(super) specification: usize,
    pub(super) quantity: Quantity,
    /// The square of the limit; of the quotient of both limits for a spread.
    allowed: f64,
    rate: f64,
}

/// What is limited.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quantity {
    /// |L/(1+L)|
    Complementary,
    /// |1/(1+L)|
    Sensitivity,
    /// |P/(1+L)|
    PlantInput,
    /// |G/(1+L)|
    Effort,
    /// |Pd/(1+L)|
    LoadMotion,
    /// |F P G/(1+L)| from above
    TrackingBelow,
    /// |F P G/(1+L)| from below
    TrackingAbove,
    /// The greatest |P G/(1+L)| over the least
    Spread,
}

/// Controller and prefilter at one frequency, and |1/(1+L)|^2 of the plants there.
#[derive(Clone, Debug, Default)]
pub(super) struct ColumnLoop {
    feedback_squared: f64,
    prefilter_squared: f64,
    sensitivity_squared: Vec<f64>,
}

/// How limits are kept to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Keeping {
    /// Every limit is drawn in by this much, dB; where two limits leave less than 1 dB between them, by that share of it.
    pub(super) reserve_db: f64,
    /// Whether a margin counts by its share of what two limits leave between them, where that is less than 1 dB. Limits that meet, as those
    /// of tracking do at rest, leave no margin otherwise that could be made greater.
    pub(super) share_of_room: bool,
}

/// Less room than this counts as this much, dB.
const ROOM_LEAST_DB: f64 = 1e-6;

/// What the specifications demand at a frequency, of a loop that has a meaning up to the highest one.
pub(super) fn demands(
    specifications: &[Specification],
    tracking: TrackingJudgement,
    Keeping { reserve_db, share_of_room }: Keeping,
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
        // the square of a magnitude moves by a tenth of a power of ten for each dB
        let room_db = ratio.map_or(1.0, |ratio| 10.0 * portable::log10(ratio)).clamp(0.0, 1.0);
        let inwards = portable::pow(10.0, -0.1 * reserve_db * room_db);
        let [lower, upper] = [lower.map(|lower| lower / inwards), upper.map(|upper| upper * inwards)];
        let limits = match specification.requirement {
            Requirement::RobustStability(_) => vec![(Quantity::Complementary, upper)],
            Requirement::Sensitivity(_) => vec![(Quantity::Sensitivity, upper)],
            Requirement::PlantInputDisturbance(_) => vec![(Quantity::PlantInput, upper)],
            Requirement::ControlEffort(_) => vec![(Quantity::Effort, upper)],
            Requirement::LoadMotion(_) => vec![(Quantity::LoadMotion, upper)],
            Requirement::Tracking { .. } if tracking == TrackingJudgement::Magnitude => {
                vec![(Quantity::TrackingBelow, upper), (Quantity::TrackingAbove, lower)]
            }
            Requirement::Tracking { .. } => {
                vec![(Quantity::Spread, ratio.map(|ratio| ratio * inwards * inwards))]
            }
        };
        demands.extend(limits.into_iter().filter_map(|(quantity, allowed)| {
            let unit = if quantity == Quantity::Spread { 2.0 } else { 1.0 };
            let rate = if share_of_room { unit * room_db.max(ROOM_LEAST_DB) } else { unit };
            Some(Demand { specification: index, quantity, allowed: allowed?, rate })
        }));
    }
    if demands.is_empty() && !specifications.is_empty() && frequency <= highest_frequency {
        demands.push(Demand::RESERVE);
    }
    demands
}

impl Demand {
    /// Where no specification demands anything: |1/(1+L)| stays below 20 dB, so that no search for the least objective slides along the
    /// edge of stability beyond the bands.
    const RESERVE: Demand =
        Demand { specification: usize::MAX, quantity: Quantity::Sensitivity, allowed: 100.0, rate: 1.0 };

    /// Whether it belongs to no specification.
    pub(super) fn is_reserve(&self) -> bool {
        self.specification == usize::MAX
    }

    /// More demands than one column can have.
    pub(super) const PER_COLUMN: usize = 64;

    /// What one dB of relaxation of every limit adds to the margin; see [`Keeping::share_of_room`].
    pub(super) fn rate(&self) -> f64 {
        self.rate
    }

    /// The power of F in what is limited, with the sign of the limit: 1 for an upper one, -1 for a lower one.
    pub(super) fn prefilter_power(&self) -> f64 {
        match self.quantity {
            Quantity::TrackingBelow => 1.0,
            Quantity::TrackingAbove => -1.0,
            _ => 0.0,
        }
    }

    /// a: the power of G in what is limited.
    fn feedback_power(&self) -> f64 {
        match self.quantity {
            Quantity::Sensitivity | Quantity::PlantInput | Quantity::LoadMotion => 0.0,
            Quantity::Complementary
            | Quantity::Effort
            | Quantity::TrackingBelow
            | Quantity::TrackingAbove
            | Quantity::Spread => 1.0,
        }
    }

    /// The square of what is limited, of the plant at this place.
    fn squared(&self, column: &Column, around: &ColumnLoop, place: usize) -> f64 {
        let sensitivity = around.sensitivity_squared[place];
        let feedback = around.feedback_squared;
        match self.quantity {
            Quantity::Complementary => column.loop_squared[place] * sensitivity * feedback,
            Quantity::Sensitivity => sensitivity,
            Quantity::PlantInput => column.plant_squared[place] * sensitivity,
            Quantity::Effort => sensitivity * feedback,
            Quantity::LoadMotion => column.load_motion_squared[place] * sensitivity,
            Quantity::TrackingBelow | Quantity::TrackingAbove => {
                column.plant_squared[place] * sensitivity * feedback * around.prefilter_squared
            }
            Quantity::Spread => column.plant_squared[place] * sensitivity * feedback,
        }
    }

    /// The square of how far the worst plant, or pair of plants, of the column goes beyond the limit; 0 where there is no plant.
    pub(super) fn worst_excess(&self, column: &Column, around: &ColumnLoop) -> f64 {
        let sensitivity = &around.sensitivity_squared;
        let feedback = around.feedback_squared;
        let forward = feedback * around.prefilter_squared;
        match self.quantity {
            Quantity::Complementary => greatest(&column.loop_squared, sensitivity) * feedback / self.allowed,
            Quantity::Sensitivity => extremes(sensitivity.iter().copied())[1] / self.allowed,
            Quantity::PlantInput => greatest(&column.plant_squared, sensitivity) / self.allowed,
            Quantity::Effort => extremes(sensitivity.iter().copied())[1] * feedback / self.allowed,
            Quantity::LoadMotion => greatest(&column.load_motion_squared, sensitivity) / self.allowed,
            Quantity::TrackingBelow => greatest(&column.plant_squared, sensitivity) * forward / self.allowed,
            Quantity::TrackingAbove => self.allowed / (least(&column.plant_squared, sensitivity) * forward),
            Quantity::Spread => {
                let [least, greatest] = extremes(products(&column.plant_squared, sensitivity));
                greatest / (least * self.allowed)
            }
        }
    }
}

impl ColumnLoop {
    /// Closes the loops of a column around this G, behind this F.
    pub(super) fn close(&mut self, column: &Column, feedback: Complex64, prefilter: Complex64) {
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

fn greatest(one: &[f64], other: &[f64]) -> f64 {
    extremes(products(one, other))[1]
}

fn least(one: &[f64], other: &[f64]) -> f64 {
    extremes(products(one, other))[0]
}

/// The least and the greatest; infinity and 0 of none.
fn extremes(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, 0.0], |[least, greatest], value| {
        [if value < least { value } else { least }, if value > greatest { value } else { greatest }]
    })
}
