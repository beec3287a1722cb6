//! A claim as two polynomials: |V| <= |U| on the whole boundary of stability and for all plants, or U without a zero there.
//!
//! ```text
//! P = N/D E, E = e^(-s tau), G = Gn/Gd, H = Hn/Hd, F = Fn/Fd, limit W = Wn/Wd, c = D Gd Hd, n = N Gn Hn, ratio r
//!
//! stable           U = n E + c                     V = 0
//! |L S| <= r W     U = r Wn (n E + c)              V = Wd n
//! |S| <= r W       U = r Wn (n E + c)              V = Wd c
//! |P S| <= r W     U = r Wn (n E + c)              V = Wd N Gd Hd
//! |G S| <= r W     U = r Wn (n E + c)              V = Wd Gn D Hd
//! |Pd S| <= r W    U = r Wn (n E + c) Dd           V = Wd Nd c          of one denominator: V = Wd Nd Gd Hd, U without Dd
//! |F T| <= r W     U = r Wn (n E + c) Fd           V = Wd Fn N Gn Hd
//! |F T| >= W/r     U = r Wd Fn N Gn Hd             V = Wn Fd (n E + c)
//! ```
//!
//! |E| = 1 on the boundary of stability, so that it is dropped where it is a factor. Powers of s that divide both are dropped.

use super::certificate::{Certificate, Limited, Member, Quotient, Segment, Side};
use super::dead_time::DeadTime;
use super::polynomial::{Decimal, InS, Polynomial, expanded};
use crate::specification::ClosedLoop;

/// The greatest exponent of a variable in a dead time, of which powers are taken.
const DEAD_TIME_EXPONENT_MAXIMUM: u8 = 4;

/// A loop in polynomials of s, over the box or at one plant.
#[derive(Clone, Debug)]
pub(crate) struct Loop<S> {
    numerator: InS<S>,
    denominator: InS<S>,
    disturbance: Option<[InS<S>; 2]>,
    /// Whether P and Pd have one denominator: the same operations.
    has_one_denominator: bool,
    feedback: [InS<S>; 2],
    prefilter: [InS<S>; 2],
    sensor: [InS<S>; 2],
    dead_time: DeadTime<S>,
}

fn quotient<S: Decimal>(quotient: &Quotient) -> [InS<S>; 2] {
    [&quotient.numerator, &quotient.denominator].map(|coefficients| InS::of_decimals(coefficients))
}

/// The values of the parameters at one plant.
fn at_member<S: Decimal>(segments: &[Segment], variables: &[f64]) -> Vec<Polynomial<S>> {
    let value = |one: &Segment| {
        let low = S::decimal(one.low);
        let share = one.variable.and_then(|variable| variables.get(variable));
        share.map_or(low, |share| low + (S::decimal(one.high) - low) * S::decimal(*share))
    };
    segments.iter().map(|one| Polynomial::constant(value(one))).collect()
}

/// U and V, each a part without dead time and one that E multiplies, at first as far as they depend on it.
#[derive(Clone, Debug)]
pub(crate) struct Claimed<S> {
    pub(crate) u: [InS<S>; 2],
    pub(crate) v: [InS<S>; 2],
    /// tau; nothing where there is none.
    pub(crate) dead_time: DeadTime<S>,
}

impl<S: Decimal> Claimed<S> {
    fn of(u: [InS<S>; 2], v: [InS<S>; 2], dead_time: &DeadTime<S>) -> Claimed<S> {
        let all = u.iter().chain(&v);
        let common = all.filter_map(InS::powers_of_s).min().unwrap_or(0);
        let without = |of: [InS<S>; 2]| of.map(|one| one.without_powers_of_s(common));
        Claimed { u: without(u), v: without(v), dead_time: dead_time.clone() }.joined()
    }

    /// With E = 1 where there is no dead time.
    fn joined(mut self) -> Claimed<S> {
        if self.dead_time.value.is_zero() {
            for one in [&mut self.u, &mut self.v] {
                *one = [one[0].plus(&one[1]), InS(vec![])];
            }
        }
        self
    }

    /// With U multiplied by a number.
    pub(crate) fn raised(&self, ratio: S) -> Claimed<S> {
        Claimed { u: [0, 1].map(|part| self.u[part].scaled(ratio)), ..self.clone() }
    }
}

impl<S: Decimal> Loop<S> {
    /// Over a whole box; `None` where the plant is not polynomial, or there is no such box.
    pub(crate) fn over_box(certificate: &Certificate, of_box: usize) -> Option<Loop<S>> {
        let segments = certificate.plant.boxes.get(of_box)?.iter();
        let values: Vec<_> =
            segments.map(|one| Polynomial::between(one.low, one.high, one.variable)).collect();
        Loop::of(certificate, &values)
    }

    /// With one plant.
    pub(crate) fn at(certificate: &Certificate, member: &Member) -> Option<Loop<S>> {
        let segments = certificate.plant.boxes.get(member.of_box)?;
        Loop::of(certificate, &at_member(segments, &member.variables))
    }

    fn of(certificate: &Certificate, parameters: &[Polynomial<S>]) -> Option<Loop<S>> {
        let plant = &certificate.plant;
        let mut left = expanded(&plant.coefficients, parameters)?.into_iter();
        let mut parts = vec![];
        for &length in &plant.lengths {
            let mut highest_first: Vec<Polynomial<S>> = left.by_ref().take(length).collect();
            highest_first.reverse();
            parts.push(InS(highest_first));
        }
        let mut dead_time = Polynomial::number(plant.delay_s);
        if plant.has_dead_time {
            dead_time = dead_time.plus(&left.next()?).up_to(DEAD_TIME_EXPONENT_MAXIMUM)?;
        }
        let mut parts = parts.into_iter();
        let (numerator, denominator) = (parts.next()?, parts.next()?);
        let results = plant.coefficients.results();
        let of_part = |part: usize| {
            let before: usize = plant.lengths.iter().take(part).sum();
            results.iter().skip(before).take(plant.lengths.get(part).copied().unwrap_or(0))
        };
        Some(Loop {
            numerator,
            denominator,
            has_one_denominator: of_part(1).eq(of_part(3)),
            disturbance: parts
                .next()
                .zip(parts.next())
                .map(|(numerator, denominator)| [numerator, denominator]),
            feedback: quotient(&certificate.feedback),
            prefilter: quotient(&certificate.prefilter),
            sensor: quotient(&certificate.sensor),
            dead_time: DeadTime { value: dead_time, terms: plant.dead_time_terms },
        })
    }

    /// Whether nothing is divided by zero.
    pub(crate) fn has_denominators(&self) -> bool {
        let quotients = [&self.feedback, &self.prefilter, &self.sensor].map(|[_, under]| under);
        let own = self.disturbance.iter().map(|[_, under]| under).chain([&self.denominator]);
        quotients.into_iter().chain(own).all(|under| under.degree().is_some())
    }

    /// c and n.
    fn open(&self) -> [InS<S>; 2] {
        let [[gn, gd], [hn, hd]] = [&self.feedback, &self.sensor];
        [self.denominator.times(gd).times(hd), self.numerator.times(gn).times(hn)]
    }

    /// n + c, as without dead time.
    pub(crate) fn without_dead_time(&self) -> InS<S> {
        let [c, n] = self.open();
        c.plus(&n)
    }

    /// That no pole stands on the boundary of stability.
    pub(crate) fn stability(&self) -> Claimed<S> {
        Claimed { u: self.open(), v: [InS(vec![]), InS(vec![])], dead_time: self.dead_time.clone() }.joined()
    }

    /// The same of one plant while its dead time grows from nothing, by the first variable.
    pub(crate) fn stability_while_delayed(&self) -> Claimed<S> {
        let value = self.dead_time.value.times(&Polynomial::between(0.0, 1.0, Some(0)));
        Claimed { dead_time: DeadTime { value, ..self.dead_time }, ..self.stability() }
    }

    /// The denominator of the prefilter.
    pub(crate) fn prefilter_denominator(&self) -> &InS<S> {
        &self.prefilter[1]
    }

    /// A limit as a claim; `None` of a plant without the path that is limited.
    pub(crate) fn claimed(&self, limited: &Limited, ratio: f64) -> Option<Claimed<S>> {
        let [[gn, gd], [fn_, fd], [_, hd]] = [&self.feedback, &self.prefilter, &self.sensor];
        let [wn, wd] = quotient(&limited.limit);
        let ratio = InS(vec![Polynomial::constant(S::decimal(ratio))]);
        let (n, d) = (&self.numerator, &self.denominator);
        // what stands over n E + c, and what besides under it
        let (over, beside) = match limited.closed_loop {
            ClosedLoop::RobustStability => (self.open()[1].clone(), None),
            ClosedLoop::Sensitivity => (self.open()[0].clone(), None),
            ClosedLoop::PlantInputDisturbance => (n.times(gd).times(hd), None),
            ClosedLoop::ControlEffort => (gn.times(d).times(hd), None),
            ClosedLoop::LoadMotion => {
                let [own, under] = self.disturbance.as_ref()?;
                match self.has_one_denominator {
                    true => (own.times(gd).times(hd), None),
                    false => (own.times(d).times(gd).times(hd), Some(under)),
                }
            }
            ClosedLoop::Tracking => (fn_.times(n).times(gn).times(hd), Some(fd)),
        };
        let under = self.open().map(|part| beside.map_or(part.clone(), |beside| part.times(beside)));
        let alone = |one: InS<S>| [one, InS(vec![])];
        let [u, v] = match limited.side {
            Side::Upper => [under.map(|part| ratio.times(&wn).times(&part)), alone(wd.times(&over))],
            Side::Lower => [alone(ratio.times(&wd).times(&over)), under.map(|part| wn.times(&part))],
        };
        Some(Claimed::of(u, v, &self.dead_time))
    }
}
