//! A claim as two polynomials: |V| <= |U| on the whole boundary of stability and for all plants, or U without a zero there.
//!
//! ```text
//! P = N/D, G = Gn/Gd, H = Hn/Hd, F = Fn/Fd, limit W = Wn/Wd, c = D Gd Hd, n = N Gn Hn, ratio r
//!
//! stable           U = n + c                     V = 0
//! |L S| <= r W     U = r Wn (n + c)              V = Wd n
//! |S| <= r W       U = r Wn (n + c)              V = Wd c
//! |P S| <= r W     U = r Wn (n + c)              V = Wd N Gd Hd
//! |G S| <= r W     U = r Wn (n + c)              V = Wd Gn D Hd
//! |Pd S| <= r W    U = r Wn (n + c) Dd           V = Wd Nd c          of one denominator: V = Wd Nd Gd Hd, U without Dd
//! |F T| <= r W     U = r Wn (n + c) Fd           V = Wd Fn N Gn Hd
//! |F T| >= W/r     U = r Wd Fn N Gn Hd           V = Wn Fd (n + c)
//! ```
//!
//! Powers of s that divide both are dropped.

use phea_dynamics::uncertain_plant::RationalCoefficients;

use super::certificate::{Certificate, CertifiedPlant, Limited, Quotient, Side};
use super::polynomial::{Decimal, InS, Polynomial, expanded};
use crate::specification::ClosedLoop;

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
}

fn quotient<S: Decimal>(quotient: &Quotient) -> [InS<S>; 2] {
    [&quotient.numerator, &quotient.denominator].map(|coefficients| InS::of_decimals(coefficients))
}

/// The values of the parameters over the whole box.
fn over_box<S: Decimal>(plant: &CertifiedPlant) -> Vec<Polynomial<S>> {
    let parameters = plant.parameters.iter();
    parameters.map(|one| Polynomial::between(one.low, one.high, one.variable)).collect()
}

/// The values of the parameters at one plant.
pub(crate) fn at_member<S: Decimal>(plant: &CertifiedPlant, member: &[f64]) -> Vec<Polynomial<S>> {
    let value = |one: &super::certificate::CertifiedParameter| {
        let low = S::decimal(one.low);
        let share = one.variable.and_then(|variable| member.get(variable));
        share.map_or(low, |share| low + (S::decimal(one.high) - low) * S::decimal(*share))
    };
    plant.parameters.iter().map(|one| Polynomial::constant(value(one))).collect()
}

impl<S: Decimal> Loop<S> {
    /// Over the whole box; `None` where the plant is not polynomial.
    pub(crate) fn over_box(certificate: &Certificate) -> Option<Loop<S>> {
        Loop::of(certificate, &over_box(&certificate.plant))
    }

    /// With one plant.
    pub(crate) fn at(certificate: &Certificate, member: &[f64]) -> Option<Loop<S>> {
        Loop::of(certificate, &at_member(&certificate.plant, member))
    }

    fn of(certificate: &Certificate, parameters: &[Polynomial<S>]) -> Option<Loop<S>> {
        let plant = &certificate.plant;
        let mut left = expanded(&plant.coefficients, parameters)?.into_iter();
        let mut parts = plant.lengths.iter().map(|&length| {
            let mut highest_first: Vec<Polynomial<S>> = left.by_ref().take(length).collect();
            highest_first.reverse();
            InS(highest_first)
        });
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
        })
    }

    /// n + c
    pub(crate) fn characteristic(&self) -> InS<S> {
        let [[gn, gd], [hn, hd]] = [&self.feedback, &self.sensor];
        let closed = self.numerator.times(gn).times(hn);
        closed.plus(&self.denominator.times(gd).times(hd))
    }

    /// The denominator of the prefilter.
    pub(crate) fn prefilter_denominator(&self) -> &InS<S> {
        &self.prefilter[1]
    }

    /// U and V; `None` of a plant without the path that is limited.
    pub(crate) fn claimed(&self, limited: &Limited, ratio: f64) -> Option<[InS<S>; 2]> {
        let [[gn, gd], [fn_, fd], [hn, hd]] = [&self.feedback, &self.prefilter, &self.sensor];
        let [wn, wd] = quotient(&limited.limit);
        let ratio = InS(vec![Polynomial::constant(S::decimal(ratio))]);
        let (n, d) = (&self.numerator, &self.denominator);
        let characteristic = self.characteristic();
        // what stands over n + c
        let (over, beside) = match limited.closed_loop {
            ClosedLoop::RobustStability => (n.times(gn).times(hn), None),
            ClosedLoop::Sensitivity => (d.times(gd).times(hd), None),
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
        let under = beside.map_or(characteristic.clone(), |beside| characteristic.times(beside));
        let [u, v] = match limited.side {
            Side::Upper => [ratio.times(&wn).times(&under), wd.times(&over)],
            Side::Lower => [ratio.times(&wd).times(&over), wn.times(&under)],
        };
        let common = u.powers_of_s().min(v.powers_of_s()).unwrap_or(0);
        Some([u, v].map(|one| one.without_powers_of_s(common)))
    }
}

/// The lengths of what an uncertain plant records, and which of its results they are.
pub(crate) fn lengths<S>(
    command: &RationalCoefficients<S>,
    disturbance: Option<&RationalCoefficients<S>>,
) -> Vec<usize> {
    let of = |one: &RationalCoefficients<S>| [one.numerator.len(), one.denominator.len()];
    of(command).into_iter().chain(disturbance.map(of).into_iter().flatten()).collect()
}
