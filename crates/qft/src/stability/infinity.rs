//! Poles that pass through infinity between one plant of a box and the next.
//!
//! Between two plants a pole becomes unstable across the stability boundary, where 1 + L vanishes
//! at some frequency, or through infinity, where the leading coefficient of the characteristic
//! equation vanishes without any effect at finite frequencies:
//!
//! ```text
//! c_0 s^N + ... + (n_0 s^M + ...) e^(-s T) = 0
//! no dead time:    c_0 + n_0 (c_0 if M < N, n_0 if M > N) keeps its sign
//! dead time:       c_0 - n_0 and c_0 + n_0 keep their signs, |L(inf)| = |n_0/c_0| < 1
//! sampled:         c_0 of the plant with its sensor, whose poles p become e^(pT); without dead time also c_0 + n_0 G(inf)
//! ```
//!
//! The recorded coefficients are enclosed over the box, which is halved until each part has one
//! sign, or a plant with the other sign is found. If enclosures are too wide to decide, the least
//! coefficient is searched for, like the worst plants in the other audits.

use std::collections::VecDeque;

use phea_dynamics::linear::Polynomial;
use phea_dynamics::order::sort_by_number;
use phea_dynamics::scalar::{Interval, Scalar};
use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients};

use super::finding::SearchedInfinity;
use crate::closed_loop::Compensation;
use crate::coordinate_climb::climb;
use crate::family::{UncertainFamily, corners};
use crate::verdict::PlantPoint;

/// Largest number of parts of the box that are enclosed; fewer if none of the first ones is
/// decided.
const PARTS_MAXIMUM: usize = 4000;
const PARTS_WITHOUT_ANY: usize = 64;
/// Number of starts of the search if the enclosures do not decide.
const STARTS: usize = 4;
/// Fraction of its nominal value that counts as clearly not zero after a search.
const CLEAR_FRACTION: f64 = 1e-3;
/// Relative change of a coefficient above which a parameter counts as moving it.
const CHANGE: f64 = 1e-3;
/// Number of additional plants that are evaluated between one sign and the other.
const BETWEEN: usize = 12;

/// Poles that pass through infinity inside the box.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Infinity {
    /// All coefficients retain their sign, as required: no pole passes through infinity.
    Kept,
    /// A pole does: these plants, given by their fractions of the box, have the opposite sign to
    /// the first member, or are next to the change of sign.
    Changed(Vec<Vec<f64>>),
    /// Searches from members and corners find no such pole.
    Searched(SearchedInfinity),
    /// Inconclusive: the search comes too close to zero.
    Open(SearchedInfinity),
}

/// The contribution of the loop to the leading coefficients of the plant: a factor of the numerator
/// (that of the denominator is 1), and the number of additional powers of s in the denominator.
struct LoopAtInfinity {
    numerator: f64,
    excess: i64,
    delay_s: f64,
    sampled: bool,
    /// Feedthrough G(inf) of a sampled loop.
    feedthrough: f64,
}

/// Searches for a change of sign over the whole box.
pub(super) fn search(family: &UncertainFamily, compensation: &Compensation) -> Infinity {
    if !family.plant().is_rational() {
        // the gain falls towards infinite frequency, as the count for every member requires
        return Infinity::Kept;
    }
    let around = LoopAtInfinity::new(compensation);
    let dimension = family.coordinates().len();
    let signs = |low: &[f64], high: &[f64]| around.leading(family, low, high);
    let nominal = family.fractions(family.plant().nominal().as_slice());
    let searched = || Searched { family, around: &around, nominal: &nominal }.evaluate();
    let first: Vec<Option<bool>> = signs(&nominal, &nominal).into_iter().map(sign).collect();
    let mut open = VecDeque::from([BoxPart { low: vec![0.0; dimension], high: vec![1.0; dimension] }]);
    let (mut enclosed, mut decided) = (0, 0);
    // the widest parts first, in which a plant with the other sign is found earliest
    while let Some(part) = open.pop_front() {
        enclosed += 1;
        if enclosed > PARTS_MAXIMUM || decided == 0 && enclosed > PARTS_WITHOUT_ANY {
            return searched();
        }
        let middle = part.middle();
        let here = signs(&part.low, &part.high);
        let cache = |(enclosure, first): (&Interval, &Option<bool>)| match first {
            Some(true) => enclosure.low() >= 0.0,
            Some(false) => enclosure.high() <= 0.0,
            None => !enclosure.has_both_signs(),
        };
        if here.iter().zip(&first).all(cache) {
            decided += 1;
            continue;
        }
        let at_middle = signs(&middle, &middle);
        let other = at_middle
            .into_iter()
            .map(sign)
            .zip(&first)
            .any(|(here, first)| first.zip(here).is_some_and(|(first, here)| first != here));
        if other {
            let is_first = |fractions: &[f64]| {
                let here = signs(fractions, fractions).into_iter().map(sign);
                here.zip(&first).all(|(here, first)| here == *first)
            };
            return Infinity::Changed(between(&nominal, &middle, &is_first));
        }
        let Some(halves) = part.halved(&middle, &signs) else { return searched() };
        open.extend(halves);
    }
    Infinity::Kept
}

/// The sign of an enclosure that has one.
fn sign(enclosure: Interval) -> Option<bool> {
    match (enclosure.low() > 0.0, enclosure.high() < 0.0) {
        (true, _) => Some(true),
        (_, true) => Some(false),
        _ => None,
    }
}

type Signs<'a> = &'a dyn Fn(&[f64], &[f64]) -> Vec<Interval>;

/// Plants from the one with the opposite sign towards the change, on the line to the first member.
fn between(from: &[f64], to: &[f64], is_first: &dyn Fn(&[f64]) -> bool) -> Vec<Vec<f64>> {
    let at = |fraction: f64| -> Vec<f64> {
        from.iter().zip(to).map(|(from, to)| from + fraction * (to - from)).collect()
    };
    let (mut same, mut other) = (0.0, 1.0);
    let mut plants = vec![at(other)];
    for _ in 0..BETWEEN {
        let middle = 0.5 * (same + other);
        let fractions = at(middle);
        if is_first(&fractions) {
            same = middle;
        } else {
            other = middle;
        }
        plants.push(fractions);
    }
    plants
}

/// The search for the least coefficient that must keep its sign, relative to the nominal plant.
struct Searched<'a> {
    family: &'a UncertainFamily,
    around: &'a LoopAtInfinity,
    nominal: &'a [f64],
}

impl Searched<'_> {
    fn evaluate(&self) -> Infinity {
        let known = self.numbers(self.nominal);
        let fraction = |fractions: &[f64]| {
            let here = self.numbers(fractions);
            let each = here.iter().zip(&known).map(|(here, known)| here / known);
            if here.len() == known.len() { each.fold(f64::INFINITY, f64::min) } else { f64::NAN }
        };
        let plants = self.family.members().iter().cloned().chain(corners(self.family));
        let mut starts: Vec<(f64, Vec<f64>)> = plants
            .map(|values| {
                let fractions = self.family.fractions(&values);
                (fraction(&fractions), fractions)
            })
            .collect();
        starts.retain(|(fraction, _)| fraction.is_finite());
        sort_by_number(&mut starts, |(fraction, _)| *fraction);
        let climbed = starts.iter().take(STARTS).map(|(_, start)| {
            let (fractions, least) = climb(start, &mut |fractions| -fraction(fractions));
            (-least, fractions)
        });
        let mut found: Vec<(f64, Vec<f64>)> = climbed.collect();
        sort_by_number(&mut found, |(least, _)| *least);
        let (least_fraction, fractions) =
            found.into_iter().next().unwrap_or_else(|| (f64::NAN, self.nominal.to_vec()));
        if least_fraction < 0.0 {
            return Infinity::Changed(between(self.nominal, &fractions, &|fractions| {
                fraction(fractions) > 0.0
            }));
        }
        let parameters = self.moving(&fraction);
        let plant = PlantPoint::Parameters(self.family.values(&fractions));
        let searched = SearchedInfinity { least_fraction, plant, parameters };
        if least_fraction > CLEAR_FRACTION { Infinity::Searched(searched) } else { Infinity::Open(searched) }
    }

    /// All coefficients of one plant that must keep their sign.
    fn numbers(&self, fractions: &[f64]) -> Vec<f64> {
        let plant = self.family.plant().coefficients(&self.family.values(fractions));
        plant.map_or(vec![], |plant| {
            let delayed = plant.dead_time_s > 0.0;
            self.around.keeping(plant, delayed)
        })
    }

    /// The parameters that move it from its nominal value, the most important first.
    fn moving(&self, fraction: &dyn Fn(&[f64]) -> f64) -> Vec<usize> {
        let change = |coordinate: usize| {
            let at = |end: f64| {
                let mut fractions = self.nominal.to_vec();
                fractions[coordinate] = end;
                (fraction(&fractions) - 1.0).abs()
            };
            at(0.0).max(at(1.0))
        };
        let coordinates = self.family.coordinates();
        let mut each: Vec<(f64, usize)> =
            (0..coordinates.len()).map(|coordinate| (change(coordinate), coordinate)).collect();
        each.retain(|(change, _)| *change > CHANGE);
        sort_by_number(&mut each, |(change, _)| -change);
        let moved = each.into_iter().filter_map(|(_, coordinate)| coordinates[coordinate].parameters.first());
        moved.copied().collect()
    }
}

/// A part of the box, by the fractions of two opposite corners.
struct BoxPart {
    low: Vec<f64>,
    high: Vec<f64>,
}

impl BoxPart {
    fn middle(&self) -> Vec<f64> {
        self.low.iter().zip(&self.high).map(|(low, high)| 0.5 * (low + high)).collect()
    }

    /// Both halves along the coordinate whose halving narrows the enclosures most; `None` if no
    /// coordinate has any remaining width.
    fn halved(&self, middle: &[f64], signs: Signs<'_>) -> Option<[BoxPart; 2]> {
        let mut chosen: Option<(f64, f64, usize)> = None;
        for (coordinate, ((&from, &to), &half)) in self.low.iter().zip(&self.high).zip(middle).enumerate() {
            let width = to - from;
            if width <= f64::EPSILON {
                continue;
            }
            let (mut low, mut high) = (self.low.clone(), self.high.clone());
            (*low.get_mut(coordinate)?, *high.get_mut(coordinate)?) = (half, half);
            let sizes = signs(&low, &high).into_iter().map(|one| one.high() - one.low());
            let left = sizes.fold(0.0, f64::max);
            // among equal ones the widest
            if chosen.is_none_or(|(least, own, _)| left < least || (left == least && width > own)) {
                chosen = Some((left, width, coordinate));
            }
        }
        let (.., coordinate) = chosen?;
        let half = *middle.get(coordinate)?;
        let (mut below, mut above) = (self.high.clone(), self.low.clone());
        (*below.get_mut(coordinate)?, *above.get_mut(coordinate)?) = (half, half);
        Some([
            BoxPart { low: self.low.clone(), high: below },
            BoxPart { low: above, high: self.high.clone() },
        ])
    }
}

impl LoopAtInfinity {
    fn new(compensation: &Compensation) -> LoopAtInfinity {
        let (feedback, sensor) = (compensation.feedback(), compensation.sensor());
        let length = |polynomial: Polynomial| polynomial.degree() as i64;
        let (sensor_n, sensor_d) = (sensor.numerator(), sensor.denominator());
        let (n, d) = (feedback.numerator(), feedback.denominator());
        let lead = sensor_n.leading_coefficient();
        let own = length(sensor_d) - length(sensor_n);
        let sampled = compensation.sample_time_s().is_some();
        let biproper = length(d.clone()) == length(n.clone()) && feedback.dead_time_s() == 0.0;
        let delay_s = compensation.delay_s() + sensor.dead_time_s() + feedback.dead_time_s();
        LoopAtInfinity {
            numerator: if sampled { lead } else { lead * n.leading_coefficient() },
            excess: if sampled { own } else { own + length(d) - length(n.clone()) },
            delay_s,
            sampled,
            feedthrough: if biproper { n.leading_coefficient() } else { 0.0 },
        }
    }

    /// Enclosures of all coefficients that must keep their sign while the fractions run from `low`
    /// to `high`.
    fn leading(&self, family: &UncertainFamily, low: &[f64], high: &[f64]) -> Vec<Interval> {
        let (from, to) = (family.values(low), family.values(high));
        let parameters: Vec<Interval> =
            from.iter().zip(&to).map(|(&from, &to)| Interval::new(from, to)).collect();
        let Some(PlantCoefficients { command, dead_time_s, .. }) = family.plant().enclosures(&parameters)
        else {
            return vec![Interval::WHOLE];
        };
        let delayed = dead_time_s.high() > 0.0;
        self.keeping(PlantCoefficients { command, dead_time_s, disturbance: None, rate: None }, delayed)
    }

    /// Coefficients of a plant that must keep their sign.
    fn keeping<S: Scalar + PartialEq>(&self, plant: PlantCoefficients<S>, plant_delays: bool) -> Vec<S> {
        let zero = S::from(0.0);
        // a coefficient that is zero for every plant is ignored
        let cache = |coefficients: Vec<S>| -> (S, i64) {
            let rest: Vec<S> = coefficients.into_iter().skip_while(|one| *one == zero).collect();
            (rest.first().copied().unwrap_or(zero), rest.len() as i64)
        };
        let RationalCoefficients { numerator, denominator } = plant.command;
        let ((n, n_length), (c_0, d_length)) = (cache(numerator), cache(denominator));
        let n_0 = n * S::from(self.numerator);
        let excess = self.excess + d_length - n_length;
        let delayed = plant_delays || self.delay_s > 0.0;
        if self.sampled {
            let together = c_0 + n_0 * S::from(self.feedthrough);
            return if excess == 0 && !delayed { vec![c_0, together] } else { vec![c_0] };
        }
        match (excess.signum(), delayed) {
            (1, _) => vec![c_0],
            (0, false) => vec![c_0 + n_0],
            (0, true) => vec![c_0 - n_0, c_0 + n_0],
            (_, false) => vec![n_0],
            (_, true) => vec![c_0, n_0],
        }
    }
}
