//! Resonances at a given frequency: plants between those of the grid, in an interval of a fraction
//! that a search steps over.
//!
//! On a line through the box the characteristic value of a lightly damped plant turns by half a
//! turn as its resonance passes the given frequency. Intervals over which it turns too far are
//! halved; from the resonance, a fraction follows its minimum, as the frequency does in other
//! searches.

use num_complex::Complex64;
use phea_dynamics::minimum;

use super::{MarginDescent, SearchCoordinate, SearchPoint, better};
use crate::verification::scan::{HALVINGS, turns};

/// Initial number of intervals of a line.
const INTERVALS: usize = 16;
/// Distance of the points next to its ends, where a minimum may begin.
const BESIDE_END: f64 = 1e-4;
/// First step of a fraction that follows its minimum.
const STEP: f64 = 0.01;
/// Accuracy of the fraction: a resonance may be narrow.
const TOLERANCE: f64 = 1e-7;

/// A plant on a line.
#[derive(Clone, Copy)]
struct LinePlant {
    fraction: f64,
    margin_db: f64,
    vanishing: Complex64,
}

impl MarginDescent<'_> {
    /// The worst result of a plain search and of searches from the resonances on the lines through
    /// its start and its end.
    pub(super) fn with_resonances(&self, start: SearchPoint) -> SearchPoint {
        let mut best = self.descended(start.clone());
        if start.frequency == 0.0 || start.frequency == f64::INFINITY {
            return best;
        }
        let mut froms = vec![start, best.clone()];
        froms.dedup_by(|one, other| one.fractions == other.fractions);
        for from in froms {
            for block in 0..from.fractions.len() {
                for coordinate in 0..self.family.coordinates().len() {
                    let along = SearchCoordinate { block, coordinate };
                    let Some(resonant) = self.resonant(&from, &best, along) else { continue };
                    let following = MarginDescent { follower: Some(along), ..*self };
                    best = better(best, Some(following.descended(resonant)));
                }
            }
        }
        best
    }

    /// The worst resonance, if any, with one plant on a line through its position in `from` and the
    /// others as in `best`.
    fn resonant(
        &self,
        from: &SearchPoint,
        best: &SearchPoint,
        along: SearchCoordinate,
    ) -> Option<SearchPoint> {
        let mut place = best.clone();
        *place.fractions.get_mut(along.block)? = from.fractions.get(along.block)?.clone();
        let [low, middle, high] = self.inner_minimum(&place, along)?;
        let place = self.moved(&place, along.block, along.coordinate, middle)?;
        Some(self.between(place, along, [low, high], TOLERANCE))
    }

    /// The fractions of the worst local minimum inside a line, and of its neighbours.
    fn inner_minimum(&self, place: &SearchPoint, along: SearchCoordinate) -> Option<[f64; 3]> {
        let samples = self.line(place, along);
        let minima = samples.windows(3).filter_map(|triple| match triple {
            [before, here, after]
                if here.margin_db <= before.margin_db && here.margin_db < after.margin_db =>
            {
                Some((here.margin_db, [before.fraction, here.fraction, after.fraction]))
            }
            _ => None,
        });
        minima.min_by(|left, right| left.0.total_cmp(&right.0)).map(|minimum| minimum.1)
    }

    /// Plants on a line, so close to each other that no resonance is hidden between them.
    fn line(&self, place: &SearchPoint, along: SearchCoordinate) -> Vec<LinePlant> {
        let mut found: Vec<LinePlant> = Vec::new();
        let inner = (1..INTERVALS).map(|index| index as f64 / INTERVALS as f64);
        for fraction in [0.0, BESIDE_END].into_iter().chain(inner).chain([1.0 - BESIDE_END, 1.0]) {
            let mut ahead: Vec<LinePlant> = self.sample(place, along, fraction).into_iter().collect();
            let mut halvings = 0;
            while let Some(next) = ahead.pop() {
                let behind = found.last().filter(|behind| turns(behind.vanishing, next.vanishing));
                let middle = behind.filter(|_| halvings < HALVINGS);
                let middle = middle.map(|behind| (behind.fraction + next.fraction) / 2.0);
                match middle.and_then(|fraction| self.sample(place, along, fraction)) {
                    Some(middle) => ahead.extend([next, middle]),
                    None => found.push(next),
                }
                halvings += 1;
            }
        }
        found
    }

    fn sample(&self, place: &SearchPoint, along: SearchCoordinate, fraction: f64) -> Option<LinePlant> {
        let mut fractions = place.fractions.get(along.block)?.clone();
        *fractions.get_mut(along.coordinate)? = fraction;
        let criterion = *self.task.criteria.get(along.block)?;
        let (vanishing, margin_db) =
            self.evaluator.resonance(criterion, &self.member(&fractions)?, place.frequency)?;
        Some(LinePlant { fraction, margin_db, vanishing })
    }

    /// The point with the follower at its minimum.
    pub(super) fn followed(&self, place: SearchPoint, follower: SearchCoordinate) -> SearchPoint {
        let alone = MarginDescent { follower: None, ..*self };
        let start = (place.fraction(follower.block, follower.coordinate), place.margin_db);
        let mut best = place;
        minimum::downhill(
            |fraction| alone.evaluated(&mut best, follower, fraction),
            [0.0, 1.0],
            start,
            STEP,
            TOLERANCE,
        );
        best
    }
}
