//! The worst case inside the box: a local search over the fractions of its coordinates, with the
//! frequency following its minimum; at a given frequency with a resonance, a fraction follows
//! instead.

mod resonance;

use std::cell::Cell;

use phea_dynamics::{minimum, portable};

use super::evaluator::{Evaluator, FREQUENCY_TOLERANCE};
use crate::closed_loop::TrialPlant;
use crate::family::UncertainFamily;

/// Largest number of sweeps over the coordinates.
const SWEEPS_MAXIMUM: usize = 20;
/// Gain of a sweep below which the search ends, dB.
const GAIN_MINIMUM: f64 = 1e-6;
/// Accuracy of a fraction.
const FRACTION_TOLERANCE: f64 = 1e-5;
/// Accuracy of a sweep while its range is still wide, as a fraction of the range.
const FRACTION_STEP: f64 = 1e-3;
/// First relative step of a frequency that follows its minimum.
const FREQUENCY_STEP: f64 = 0.01;

/// Start of a search.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SearchTask {
    /// The criteria whose margins are summed, each with a separate plant.
    pub(super) criteria: Vec<usize>,
    /// Fractions of each plant.
    pub(super) fractions: Vec<Vec<f64>>,
    /// Frequency, rad/s; zero and infinity denote limits.
    pub(super) frequency: f64,
    /// The range in which the frequency may move; `None` if it is fixed.
    pub(super) range: Option<[f64; 2]>,
    /// True if resonances between the plants are searched for at a given frequency.
    pub(super) resonances: bool,
}

/// The end of a search, and the first plant encountered that has no margin at some frequency.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct SearchOutcome {
    pub(super) found: Option<SearchEnd>,
    pub(super) undefined: Option<f64>,
}

/// End of a search.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SearchEnd {
    pub(super) margin_db: f64,
    pub(super) frequency: f64,
    /// Parameter values of each plant.
    pub(super) values: Vec<Vec<f64>>,
}

/// A point of the search.
#[derive(Clone, Debug)]
struct SearchPoint {
    fractions: Vec<Vec<f64>>,
    members: Vec<Option<TrialPlant>>,
    margin_db: f64,
    frequency: f64,
}

/// Descends from a start until a sweep over all coordinates gains nothing.
pub(super) fn search(
    evaluator: &Evaluator<'_>,
    family: &UncertainFamily,
    task: &SearchTask,
) -> SearchOutcome {
    let descent = MarginDescent { evaluator, family, task, follower: None, undefined: &Cell::new(None) };
    let place = descent.start().map(|start| match task.resonances {
        true => descent.with_resonances(start),
        false => descent.descended(start),
    });
    let found = place.and_then(|place| {
        Some(SearchEnd {
            margin_db: descent.confirmed(&place)?,
            frequency: place.frequency,
            values: place.fractions.iter().map(|fractions| family.values(fractions)).collect(),
        })
    });
    SearchOutcome { found, undefined: descent.undefined.get() }
}

/// A coordinate of one of the plants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct SearchCoordinate {
    block: usize,
    coordinate: usize,
}

#[derive(Clone, Copy)]
struct MarginDescent<'a> {
    evaluator: &'a Evaluator<'a>,
    family: &'a UncertainFamily,
    task: &'a SearchTask,
    /// The fraction that follows its minimum.
    follower: Option<SearchCoordinate>,
    undefined: &'a Cell<Option<f64>>,
}

impl MarginDescent<'_> {
    fn member(&self, fractions: &[f64]) -> Option<TrialPlant> {
        self.evaluator.trial(self.family.plant(), &self.family.values(fractions))
    }

    fn start(&self) -> Option<SearchPoint> {
        let members: Vec<Option<TrialPlant>> =
            self.task.fractions.iter().map(|fractions| self.member(fractions)).collect();
        self.settled(self.task.fractions.clone(), members, self.task.frequency)
    }

    /// The margin at the end of a search for the whole plants: a result found only with their modes
    /// is evaluated like that of every other plant.
    fn confirmed(&self, place: &SearchPoint) -> Option<f64> {
        let mut plants = self.task.criteria.iter().zip(&place.members);
        let sum = plants.try_fold(0.0, |sum, (&criterion, plant)| {
            let whole = plant.as_ref()?.whole(self.evaluator.compensation)?;
            Some(sum + self.evaluator.margin_db(criterion, &whole, place.frequency)?)
        });
        if sum.is_none() && self.undefined.get().is_none() {
            self.undefined.set(Some(place.frequency));
        }
        sum
    }

    fn descended(&self, start: SearchPoint) -> SearchPoint {
        let mut place = start;
        let mut radius = 0.25;
        for sweep in 0..SWEEPS_MAXIMUM {
            let before = place.clone();
            for block in 0..place.fractions.len() {
                for coordinate in 0..self.family.coordinates().len() {
                    if self.moves(block, coordinate) {
                        place = self.along(
                            place,
                            block,
                            coordinate,
                            radius,
                            sweep == 0 && self.follower.is_none(),
                        );
                    }
                }
            }
            place = self.onwards(&before, place);
            let gained = before.margin_db - place.margin_db;
            if gained.is_nan() || gained < GAIN_MINIMUM {
                break;
            }
            radius = (radius / 2.0).max(0.01);
        }
        place
    }

    /// True if a coordinate moves: with a follower, only those of its plant except the follower
    /// itself.
    fn moves(&self, block: usize, coordinate: usize) -> bool {
        self.follower.is_none_or(|follower| follower.block == block && follower.coordinate != coordinate)
    }

    /// A point whose frequency, or follower, is at its minimum.
    fn settled(
        &self,
        fractions: Vec<Vec<f64>>,
        members: Vec<Option<TrialPlant>>,
        frequency: f64,
    ) -> Option<SearchPoint> {
        let (frequency, margin_db) = self.margin(&members, frequency)?;
        let place = SearchPoint { fractions, members, margin_db, frequency };
        Some(match self.follower {
            Some(follower) => self.followed(place, follower),
            None => place,
        })
    }

    /// The margin at the frequency nearest to this one at which it has a minimum: (rad/s, dB).
    fn margin(&self, members: &[Option<TrialPlant>], frequency: f64) -> Option<(f64, f64)> {
        let at = |frequency: f64| {
            let mut margins = self.task.criteria.iter().zip(members);
            let sum = margins.try_fold(0.0, |sum, (&criterion, member)| {
                Some(sum + self.evaluator.trial_margin_db(criterion, member.as_ref()?, frequency)?)
            });
            let sum = sum.filter(|sum: &f64| !sum.is_nan());
            if sum.is_none() && self.undefined.get().is_none() {
                self.undefined.set(Some(frequency));
            }
            sum
        };
        let here = at(frequency)?;
        let Some([low, high]) = self.task.range else {
            return Some((frequency, here));
        };
        let within = |logarithm: f64| portable::exp(logarithm).clamp(low, high);
        let logarithmic = |logarithm: f64| at(within(logarithm)).unwrap_or(f64::INFINITY);
        let ends = [portable::ln(low), portable::ln(high)];
        let start = (portable::ln(frequency), here);
        let (logarithm, margin) =
            minimum::downhill(logarithmic, ends, start, FREQUENCY_STEP, FREQUENCY_TOLERANCE);
        Some(if margin < here { (within(logarithm), margin) } else { (frequency, here) })
    }

    /// The point with another fraction of one coordinate, and its margin.
    fn moved(
        &self,
        place: &SearchPoint,
        block: usize,
        coordinate: usize,
        fraction: f64,
    ) -> Option<SearchPoint> {
        let mut fractions = place.fractions.clone();
        *fractions.get_mut(block)?.get_mut(coordinate)? = fraction;
        let mut members = place.members.clone();
        *members.get_mut(block)? = self.member(fractions.get(block)?);
        self.settled(fractions, members, place.frequency)
    }

    /// The best point along one coordinate: the neighbourhood of this fraction, those of both ends
    /// and, on the first sweep, that of the middle.
    fn along(
        &self,
        place: SearchPoint,
        block: usize,
        coordinate: usize,
        radius: f64,
        first: bool,
    ) -> SearchPoint {
        let elsewhere: &[f64] = if first { &[0.0, 0.5, 1.0] } else { &[0.0, 1.0] };
        let mut best = self.near(place.clone(), block, coordinate, radius);
        for &fraction in elsewhere {
            let Some(other) = self.moved(&place, block, coordinate, fraction) else { continue };
            let other = if first { self.near(other, block, coordinate, radius) } else { other };
            best = better(best, Some(other));
        }
        best
    }

    /// The local minimum along one coordinate, no further than `radius` away.
    fn near(&self, place: SearchPoint, block: usize, coordinate: usize, radius: f64) -> SearchPoint {
        let fraction = place.fraction(block, coordinate);
        let ends = [(fraction - radius).max(0.0), (fraction + radius).min(1.0)];
        let tolerance = (FRACTION_STEP * radius).max(FRACTION_TOLERANCE);
        self.between(place, SearchCoordinate { block, coordinate }, ends, tolerance)
    }

    /// The local minimum between two fractions of one coordinate.
    fn between(
        &self,
        place: SearchPoint,
        along: SearchCoordinate,
        ends: [f64; 2],
        tolerance: f64,
    ) -> SearchPoint {
        let start = (place.fraction(along.block, along.coordinate), place.margin_db);
        let mut best = place;
        minimum::between(|fraction| self.evaluated(&mut best, along, fraction), ends, start, tolerance);
        best
    }

    /// The margin with another fraction; the best point so far is retained.
    fn evaluated(&self, best: &mut SearchPoint, along: SearchCoordinate, fraction: f64) -> f64 {
        match self.moved(best, along.block, along.coordinate, fraction) {
            Some(found) => {
                let margin_db = found.margin_db;
                *best = better(best.clone(), Some(found));
                margin_db
            }
            None => f64::INFINITY,
        }
    }

    /// Continues in the direction of a sweep, in steps that double, as long as the margin
    /// decreases.
    fn onwards(&self, from: &SearchPoint, to: SearchPoint) -> SearchPoint {
        let mut best = to.clone();
        let mut factor = 1.0;
        for _ in 0..10 {
            let further = |(from, to): (&f64, &f64)| (to + factor * (to - from)).clamp(0.0, 1.0);
            let fractions: Vec<Vec<f64>> = from
                .fractions
                .iter()
                .zip(&to.fractions)
                .map(|(from, to)| from.iter().zip(to).map(further).collect())
                .collect();
            if fractions == best.fractions {
                break;
            }
            let members: Vec<Option<TrialPlant>> =
                fractions.iter().map(|fractions| self.member(fractions)).collect();
            match self.settled(fractions, members, best.frequency) {
                Some(found) if found.margin_db < best.margin_db => best = found,
                _ => break,
            }
            factor *= 2.0;
        }
        best
    }
}

impl SearchPoint {
    fn fraction(&self, block: usize, coordinate: usize) -> f64 {
        self.fractions.get(block).and_then(|fractions| fractions.get(coordinate)).copied().unwrap_or(0.0)
    }
}

fn better(place: SearchPoint, other: Option<SearchPoint>) -> SearchPoint {
    match other {
        Some(other) if other.margin_db < place.margin_db => other,
        _ => place,
    }
}
