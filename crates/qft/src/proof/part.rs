//! Products of a polynomial in s and functions of only the frequency, including sampled ones: the
//! building blocks of the loops of a certificate.
//!
//! ```text
//! z = e^(j w T),   zeta = z - 1 = j w T e^(j w T) hold,   hold = (1 - e^(-j w T))/(j w T)
//! ```
//!
//! zeta is zero where s is: a factor zeta is written as s, so that an integrator in z can cancel
//! one in s.

use super::certificate::{ControlLaw, Quotient, Sections};
use super::over_panel::{Complex, Middle, OverPanel, product, sum};
use super::polynomial::{BoxPolynomial, Decimal, InS};

/// A function of only the frequency.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum OfFrequency<S> {
    /// A polynomial in zeta with these decimals, highest power first.
    Polynomial(Vec<f64>),
    /// The zero-order hold, with a height of one at zero frequency.
    Hold,
    /// Delay by this time, s.
    Late(S),
    /// Advance by one sample.
    Ahead,
    /// A part of a limit given as a table.
    Straight(Straight),
}

/// A power of the frequency between two points of a table: linear in a double logarithmic diagram.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Straight {
    /// Frequency, rad/s, and magnitude.
    pub(crate) from: (f64, f64),
    /// The next point.
    pub(crate) to: (f64, f64),
}

impl Straight {
    /// The segments between the points of a table.
    pub(super) fn of_table(points: &[(f64, f64)]) -> impl Iterator<Item = Straight> {
        points.windows(2).map(|pair| Straight { from: pair[0], to: pair[1] })
    }
}

/// One product.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PolynomialProduct<S> {
    pub(crate) of_s: InS<S>,
    pub(crate) of_frequency: Vec<OfFrequency<S>>,
}

impl<S: Decimal> PolynomialProduct<S> {
    pub(crate) fn of(of_s: InS<S>) -> PolynomialProduct<S> {
        PolynomialProduct { of_s, of_frequency: vec![] }
    }

    pub(crate) fn times(&self, other: &PolynomialProduct<S>) -> PolynomialProduct<S> {
        let of_frequency = self.of_frequency.iter().chain(&other.of_frequency).cloned().collect();
        PolynomialProduct { of_s: self.of_s.times(&other.of_s), of_frequency }
    }

    pub(crate) fn scaled(&self, factor: S) -> PolynomialProduct<S> {
        PolynomialProduct { of_s: self.of_s.scaled(factor), of_frequency: self.of_frequency.clone() }
    }

    /// Product of its functions of the frequency over a panel; `None` if it has none.
    pub(super) fn over(&self, middle: Middle<S>, sample_time_s: S) -> Option<OverPanel<S>> {
        let each = self.of_frequency.iter().map(|one| match one {
            OfFrequency::Polynomial(coefficients) => {
                middle.polynomial(coefficients, &middle.step(sample_time_s))
            }
            OfFrequency::Hold => middle.hold(sample_time_s),
            OfFrequency::Late(time_s) => middle.turned(*time_s),
            OfFrequency::Ahead => middle.turned(-sample_time_s),
            OfFrequency::Straight(straight) => middle.straight(*straight),
        });
        each.reduce(|one, other| middle.product(&one, &other))
    }

    /// Value at a frequency, with numbers as coefficients.
    pub(super) fn value(&self, frequency: S, sample_time_s: S) -> Complex<S> {
        let of_s = value(&self.of_s, frequency);
        let middle = Middle::of([frequency, frequency], 1);
        self.over(middle, sample_time_s).map_or(of_s, |factor| product(of_s, factor.value()))
    }
}

/// The value of a polynomial whose coefficients are numbers, at s = j w.
pub(super) fn value<S: Decimal>(of: &InS<S>, frequency: S) -> Complex<S> {
    of.0.iter().rev().fold([S::from(0.0); 2], |known, coefficient| {
        let turned = [-(known[1] * frequency), known[0] * frequency];
        sum(turned, [number(coefficient), S::from(0.0)])
    })
}

/// The value of a polynomial that depends on no variable.
pub(super) fn number<S: Decimal>(of: &BoxPolynomial<S>) -> S {
    of.terms().fold(S::uncertain(of.rest().most()), |sum, (_, value)| sum + value)
}

/// Numerator and denominator.
pub(super) fn quotient<S: Decimal>(quotient: &Quotient) -> [InS<S>; 2] {
    [&quotient.numerator, &quotient.denominator].map(|coefficients| InS::of_decimals(coefficients))
}

/// Numerator and denominator of a compensator.
pub(super) fn law<S: Decimal>(law: &ControlLaw, sample_time_s: Option<f64>) -> [PolynomialProduct<S>; 2] {
    match law {
        ControlLaw::Continuous(own) => quotient(own).map(PolynomialProduct::of),
        ControlLaw::Sampled(Sections { gain, numerator, denominator }) => {
            let gain = PolynomialProduct::of(InS(vec![BoxPolynomial::number(*gain)]));
            let sample_time_s = sample_time_s.map_or(S::from(0.0), S::decimal);
            let one = PolynomialProduct::of(InS(vec![BoxPolynomial::number(1.0)]));
            let of = |sections: &[Vec<f64>], start: PolynomialProduct<S>| {
                sections.iter().fold(start, |known, section| known.times(&of_section(section, sample_time_s)))
            };
            [of(numerator, gain), of(denominator, one)]
        }
    }
}

/// A polynomial in zeta, with factors zeta written as s.
fn of_section<S: Decimal>(section: &[f64], sample_time_s: S) -> PolynomialProduct<S> {
    let integrators = section.iter().rev().take_while(|coefficient| **coefficient == 0.0).count();
    let mut out = PolynomialProduct::of(InS(vec![BoxPolynomial::number(1.0)]));
    for _ in 0..integrators {
        let s = InS(vec![BoxPolynomial::zero(), BoxPolynomial::constant(sample_time_s)]);
        out = out
            .times(&PolynomialProduct { of_s: s, of_frequency: vec![OfFrequency::Hold, OfFrequency::Ahead] });
    }
    let left = &section[..section.len() - integrators];
    match left {
        [number] => out.scaled(S::decimal(*number)),
        _ => out.times(&PolynomialProduct {
            of_s: InS(vec![BoxPolynomial::number(1.0)]),
            of_frequency: vec![OfFrequency::Polynomial(left.to_vec())],
        }),
    }
}
