//! Poles that pass through infinity between one plant of a box and the next.
//!
//! Between two plants a pole becomes unstable across the boundary of stability, where 1 + L
//! vanishes at some frequency, or through infinity, where the leading coefficient of the
//! characteristic equation vanishes without a trace at any frequency:
//!
//! ```text
//! c_0 s^N + ... + (n_0 s^M + ...) e^(-s T) = 0
//! no dead time:    c_0 + n_0 (c_0 where M < N, n_0 where M > N) keeps its sign
//! dead time:       c_0 - n_0 and c_0 + n_0 keep theirs, |L(inf)| = |n_0/c_0| < 1
//! sampled:         c_0 of the plant with its sensor, whose poles p become e^(pT); without dead time also c_0 + n_0 G(inf)
//! ```
//!
//! The recorded coefficients are enclosed over the box, which is halved until each part has one
//! sign, or a plant with the other sign is found.

use std::collections::VecDeque;

use phea_dynamics::linear::Polynomial;
use phea_dynamics::scalar::Interval;
use phea_dynamics::uncertain_plant::PlantCoefficients;

use crate::closed_loop::Compensation;
use crate::family::UncertainFamily;

/// Parts of the box that are enclosed.
const PARTS_MAXIMUM: usize = 4000;
/// Additional plants between one sign and the other that are judged.
const BETWEEN: usize = 12;

/// Whether a pole passes through infinity inside the box.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Infinity {
    /// No: the coefficients that must keep their sign do.
    Kept,
    /// Yes: these plants, given by their shares of the box, have the opposite sign to the first
    /// member, or lie next to the change of sign.
    Changed(Vec<Vec<f64>>),
    /// Neither was shown.
    Open,
}

/// The contribution of the loop to the leading coefficients of the plant: a factor of the numerator
/// (that of the denominator is 1), and the number of additional powers of s in the denominator.
struct LoopAtInfinity {
    numerator: f64,
    excess: i64,
    delay_s: f64,
    sampled: bool,
    /// G(inf) of a sampled loop.
    feedthrough: f64,
}

/// Looks for a change of sign over the whole box.
pub(super) fn search(family: &UncertainFamily, compensation: &Compensation) -> Infinity {
    if !family.plant().is_rational() {
        // its gain falls towards infinite frequency, which the count of every member requires
        return Infinity::Kept;
    }
    let around = LoopAtInfinity::new(compensation);
    let dimension = family.coordinates().len();
    let signs = |low: &[f64], high: &[f64]| around.leading(family, low, high);
    let nominal = family.shares(family.plant().nominal().as_slice());
    let first: Vec<Option<bool>> = signs(&nominal, &nominal).into_iter().map(sign).collect();
    let mut open = VecDeque::from([BoxPart { low: vec![0.0; dimension], high: vec![1.0; dimension] }]);
    let mut enclosed = 0;
    // the widest parts first, in which a plant with the other sign is found soonest
    while let Some(part) = open.pop_front() {
        enclosed += 1;
        if enclosed > PARTS_MAXIMUM {
            return Infinity::Open;
        }
        let middle = part.middle();
        let here = signs(&part.low, &part.high);
        let kept = |(enclosure, first): (&Interval, &Option<bool>)| match first {
            Some(true) => enclosure.low() >= 0.0,
            Some(false) => enclosure.high() <= 0.0,
            None => !enclosure.has_both_signs(),
        };
        if here.iter().zip(&first).all(kept) {
            continue;
        }
        let at_middle = signs(&middle, &middle);
        let other = at_middle
            .into_iter()
            .map(sign)
            .zip(&first)
            .any(|(here, first)| first.zip(here).is_some_and(|(first, here)| first != here));
        if other {
            return Infinity::Changed(between(&nominal, &middle, &first, &signs));
        }
        let Some(halves) = part.halved(&middle, &signs) else { return Infinity::Open };
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

/// Plants from the one with the other sign towards the change, on the line to the first member.
fn between(from: &[f64], to: &[f64], first: &[Option<bool>], signs: Signs<'_>) -> Vec<Vec<f64>> {
    let at = |share: f64| -> Vec<f64> {
        from.iter().zip(to).map(|(from, to)| from + share * (to - from)).collect()
    };
    let (mut same, mut other) = (0.0, 1.0);
    let mut plants = vec![at(other)];
    for _ in 0..BETWEEN {
        let middle = 0.5 * (same + other);
        let shares = at(middle);
        let here = signs(&shares, &shares).into_iter().map(sign);
        if here.zip(first).all(|(here, first)| here == *first) {
            same = middle;
        } else {
            other = middle;
        }
        plants.push(shares);
    }
    plants
}

/// A part of the box, by the shares of two opposite corners.
struct BoxPart {
    low: Vec<f64>,
    high: Vec<f64>,
}

impl BoxPart {
    fn middle(&self) -> Vec<f64> {
        self.low.iter().zip(&self.high).map(|(low, high)| 0.5 * (low + high)).collect()
    }

    /// Both halves along the coordinate whose halving narrows the enclosures most; `None` where no
    /// coordinate has any width left.
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
            // among equals the widest
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

    /// Enclosures of everything that must keep its sign while the shares run from `low` to `high`.
    fn leading(&self, family: &UncertainFamily, low: &[f64], high: &[f64]) -> Vec<Interval> {
        let (from, to) = (family.values(low), family.values(high));
        let parameters: Vec<Interval> =
            from.iter().zip(&to).map(|(&from, &to)| Interval::new(from, to)).collect();
        let Some(PlantCoefficients { command, dead_time_s, .. }) = family.plant().enclosures(&parameters)
        else {
            return vec![Interval::WHOLE];
        };
        let zero = Interval::from(0.0);
        // a coefficient that is zero for every plant does not count
        let kept = |coefficients: Vec<Interval>| -> (Interval, i64) {
            let rest: Vec<Interval> = coefficients.into_iter().skip_while(|one| *one == zero).collect();
            (rest.first().copied().unwrap_or(zero), rest.len() as i64)
        };
        let ((n, n_length), (c_0, d_length)) = (kept(command.numerator), kept(command.denominator));
        let n_0 = n * Interval::from(self.numerator);
        let excess = self.excess + d_length - n_length;
        let delayed = dead_time_s.high() > 0.0 || self.delay_s > 0.0;
        if self.sampled {
            let together = c_0 + n_0 * Interval::from(self.feedthrough);
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
