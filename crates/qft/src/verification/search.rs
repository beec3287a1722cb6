//! The worst case inside the box: a local search over the shares of its coordinates, the frequency following its minimum.

use std::cell::Cell;

use phea_dynamics::portable;

use super::evaluator::{Evaluator, FREQUENCY_TOLERANCE};
use super::minimum::{self, At};
use crate::closed_loop::Member;
use crate::family::UncertainFamily;

/// Sweeps over the coordinates at most.
const SWEEPS_MAXIMUM: usize = 20;
/// A sweep that gains less than this ends the search, dB.
const GAIN_MINIMUM: f64 = 1e-6;
/// Shares are found to this.
const SHARE_TOLERANCE: f64 = 1e-5;
/// As long as a sweep still looks far, to this share of how far.
const SHARE_STEP: f64 = 1e-3;
/// First step of a frequency that follows its minimum, as a share of itself.
const FREQUENCY_STEP: f64 = 0.01;

/// Where a search starts.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Task {
    /// The criteria whose margins are summed, each with a plant of its own.
    pub(super) criteria: Vec<usize>,
    /// Shares of each plant.
    pub(super) shares: Vec<Vec<f64>>,
    /// rad/s; zero and infinity are limits.
    pub(super) frequency: f64,
    /// Between which the frequency may move; `None` where it is given.
    pub(super) range: Option<[f64; 2]>,
}

/// What a search ended at, and the first plant on its way that has no margin at some frequency.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Outcome {
    pub(super) found: Option<Found>,
    pub(super) undefined: Option<f64>,
}

/// Where a search ended.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Found {
    pub(super) margin_db: f64,
    pub(super) frequency: f64,
    /// Parameter values of each plant.
    pub(super) values: Vec<Vec<f64>>,
}

/// A point of the search.
#[derive(Clone, Debug)]
struct Place {
    shares: Vec<Vec<f64>>,
    members: Vec<Option<Member>>,
    margin_db: f64,
    frequency: f64,
}

/// Goes downhill from a start until a sweep over all coordinates gains nothing.
pub(super) fn search(evaluator: &Evaluator, family: &UncertainFamily, task: &Task) -> Outcome {
    let descent = Descent { evaluator, family, task, undefined: Cell::new(None) };
    let found = descent.start().map(|start| descent.descended(start));
    Outcome { found, undefined: descent.undefined.get() }
}

struct Descent<'a> {
    evaluator: &'a Evaluator,
    family: &'a UncertainFamily,
    task: &'a Task,
    undefined: Cell<Option<f64>>,
}

impl Descent<'_> {
    fn member(&self, shares: &[f64]) -> Option<Member> {
        self.evaluator.member(self.family.plant(), &self.family.values(shares))
    }

    fn start(&self) -> Option<Place> {
        let members: Vec<Option<Member>> =
            self.task.shares.iter().map(|shares| self.member(shares)).collect();
        let (frequency, margin_db) = self.margin(&members, self.task.frequency)?;
        Some(Place { shares: self.task.shares.clone(), members, margin_db, frequency })
    }

    fn descended(&self, start: Place) -> Found {
        let mut place = start;
        let mut radius = 0.25;
        for sweep in 0..SWEEPS_MAXIMUM {
            let before = place.clone();
            for block in 0..place.shares.len() {
                for coordinate in 0..self.family.coordinates().len() {
                    place = self.along(place, block, coordinate, radius, sweep == 0);
                }
            }
            place = self.onwards(&before, place);
            let gained = before.margin_db - place.margin_db;
            if gained.is_nan() || gained < GAIN_MINIMUM {
                break;
            }
            radius = (radius / 2.0).max(0.01);
        }
        let values = place.shares.iter().map(|shares| self.family.values(shares)).collect();
        Found { margin_db: place.margin_db, frequency: place.frequency, values }
    }

    /// The margin at the frequency nearest to this one at which it has a minimum: (rad/s, dB).
    fn margin(&self, members: &[Option<Member>], frequency: f64) -> Option<At> {
        let at = |frequency: f64| {
            let mut margins = self.task.criteria.iter().zip(members);
            let sum = margins.try_fold(0.0, |sum, (&criterion, member)| {
                Some(sum + self.evaluator.margin_db(criterion, member.as_ref()?, frequency)?)
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

    /// The same place with another share of one coordinate, and its margin.
    fn moved(&self, place: &Place, block: usize, coordinate: usize, share: f64) -> Option<Place> {
        let mut shares = place.shares.clone();
        *shares.get_mut(block)?.get_mut(coordinate)? = share;
        let mut members = place.members.clone();
        *members.get_mut(block)? = self.member(shares.get(block)?);
        let (frequency, margin_db) = self.margin(&members, place.frequency)?;
        Some(Place { shares, members, margin_db, frequency })
    }

    /// The best place along one coordinate: the neighbourhood of this share, and those of both ends; on the first sweep of the
    /// middle as well.
    fn along(&self, place: Place, block: usize, coordinate: usize, radius: f64, first: bool) -> Place {
        let elsewhere: &[f64] = if first { &[0.0, 0.5, 1.0] } else { &[0.0, 1.0] };
        let mut best = self.near(place.clone(), block, coordinate, radius);
        for &share in elsewhere {
            let Some(other) = self.moved(&place, block, coordinate, share) else { continue };
            let other = if first { self.near(other, block, coordinate, radius) } else { other };
            best = better(best, Some(other));
        }
        best
    }

    /// The local minimum along one coordinate, no further than `radius` away.
    fn near(&self, place: Place, block: usize, coordinate: usize, radius: f64) -> Place {
        let share = place.shares.get(block).and_then(|shares| shares.get(coordinate)).copied().unwrap_or(0.0);
        let ends = [(share - radius).max(0.0), (share + radius).min(1.0)];
        let mut best = place;
        if ends.contains(&share) {
            // an end of the box that is a minimum rises inwards
            let inwards = if share == ends[0] { share + radius / 8.0 } else { share - radius / 8.0 };
            match self.moved(&best, block, coordinate, inwards) {
                Some(inside) if inside.margin_db < best.margin_db => best = inside,
                _ => return best,
            }
        }
        let share = best.shares.get(block).and_then(|shares| shares.get(coordinate)).copied().unwrap_or(0.0);
        let start = (share, best.margin_db);
        let margin = |share: f64| match self.moved(&best, block, coordinate, share) {
            Some(found) => {
                let margin_db = found.margin_db;
                best = better(best.clone(), Some(found));
                margin_db
            }
            None => f64::INFINITY,
        };
        minimum::between(margin, ends, start, (SHARE_STEP * radius).max(SHARE_TOLERANCE));
        best
    }

    /// Once more in the direction in which a sweep went, in steps that double, as long as it helps.
    fn onwards(&self, from: &Place, to: Place) -> Place {
        let mut best = to.clone();
        let mut factor = 1.0;
        for _ in 0..10 {
            let further = |(from, to): (&f64, &f64)| (to + factor * (to - from)).clamp(0.0, 1.0);
            let shares: Vec<Vec<f64>> = from
                .shares
                .iter()
                .zip(&to.shares)
                .map(|(from, to)| from.iter().zip(to).map(further).collect())
                .collect();
            if shares == best.shares {
                break;
            }
            let members: Vec<Option<Member>> = shares.iter().map(|shares| self.member(shares)).collect();
            match self.margin(&members, best.frequency) {
                Some((frequency, margin_db)) if margin_db < best.margin_db => {
                    best = Place { shares, members, margin_db, frequency };
                }
                _ => break,
            }
            factor *= 2.0;
        }
        best
    }
}

fn better(place: Place, other: Option<Place>) -> Place {
    match other {
        Some(other) if other.margin_db < place.margin_db => other,
        _ => place,
    }
}
