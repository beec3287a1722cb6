//! Dead time over a panel of frequencies: a polynomial, and a remainder.
//!
//! ```text
//! e^(-j w tau) = e^(-j a) e^(-j d),   d = w tau - a,   e^(-j d) = sum over k < m of (-j d)^k/k! + r,   |r| <= |d|^m/m!
//! ```

use phea_dynamics::scalar::{Interval, Scalar};

use super::points::PanelRange;
use super::polynomial::{BoxPolynomial, Decimal, InS};

/// A dead time, and the number of terms of the series.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DeadTime<S> {
    /// Dead time, s.
    pub(super) value: BoxPolynomial<S>,
    /// Number of terms m.
    pub(super) terms: usize,
}

/// A complex polynomial in the frequency, the lowest power first.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct InFrequency<S> {
    pub(super) real: InS<S>,
    pub(super) imaginary: InS<S>,
}

impl<S: Decimal> InFrequency<S> {
    pub(super) fn none() -> InFrequency<S> {
        InFrequency { real: InS(vec![]), imaginary: InS(vec![]) }
    }

    pub(super) fn parts(&self) -> [&[BoxPolynomial<S>]; 2] {
        [&self.real.0, &self.imaginary.0]
    }

    pub(super) fn plus(&self, other: &InFrequency<S>) -> InFrequency<S> {
        InFrequency { real: self.real.plus(&other.real), imaginary: self.imaginary.plus(&other.imaginary) }
    }

    pub(super) fn times(&self, other: &InFrequency<S>) -> InFrequency<S> {
        let minus = S::from(-1.0);
        InFrequency {
            real: self.real.times(&other.real).plus(&self.imaginary.times(&other.imaginary).scaled(minus)),
            imaginary: self.real.times(&other.imaginary).plus(&self.imaginary.times(&other.real)),
        }
    }

    /// Polynomial in powers of x, with the frequency `low + width x`: shifted, then scaled.
    pub(super) fn along(&self, low: S, width: S) -> InFrequency<S> {
        let one = |of: &InS<S>| {
            let mut terms = of.0.clone();
            let degree = terms.len().saturating_sub(1);
            for step in 0..degree {
                for place in (step..degree).rev() {
                    terms[place] = terms[place].plus(&terms[place + 1].scaled(low));
                }
            }
            let mut factor = S::from(1.0);
            for term in &mut terms {
                *term = term.scaled(factor);
                factor = factor * width;
            }
            InS(terms)
        };
        InFrequency { real: one(&self.real), imaginary: one(&self.imaginary) }
    }

    /// Raises the degrees of the axes to those of this polynomial.
    pub(super) fn raise_degrees(&self, degrees: &mut [usize]) {
        for one in [&self.real, &self.imaginary] {
            degrees[0] = degrees[0].max(one.degree().unwrap_or(0));
            for (exponents, _) in one.0.iter().flat_map(BoxPolynomial::terms) {
                for (degree, exponent) in degrees.iter_mut().skip(1).zip(exponents) {
                    *degree = (*degree).max(usize::from(*exponent));
                }
            }
        }
    }
}

/// Phase factor e^(-j w tau) over a finite panel, without the remainder, in powers of x as in
/// [`InFrequency::along`].
pub(super) fn turned<S: Decimal>(dead_time: &DeadTime<S>, range: PanelRange, angle: f64) -> InFrequency<S> {
    let PanelRange { from, to, .. } = range;
    let by = |frequency: S| dead_time.value.scaled(frequency);
    let begin = by(S::decimal(from)).plus(&BoxPolynomial::number(-angle));
    let turn = InS(vec![begin, by(S::decimal(to) - S::decimal(from))]);
    let mut sums = [InS(vec![]), InS(vec![])];
    let mut term = InS(vec![BoxPolynomial::number(1.0)]);
    for power in 0..dead_time.terms {
        // (-j)^k: 1, -j, -1, j
        let sign = if (power + 1) % 4 < 2 { 1.0 } else { -1.0 };
        sums[power % 2] = sums[power % 2].plus(&term.scaled(S::from(sign)));
        term = term.times(&turn).scaled(S::from(1.0) / S::from((power + 1) as f64));
    }
    let [real, imaginary] = sums;
    let [cosine, sine] =
        S::cosine_and_sine(S::decimal(angle)).map(|value| InS(vec![BoxPolynomial::constant(value)]));
    let start = InFrequency { real: cosine, imaginary: sine.scaled(S::from(-1.0)) };
    start.times(&InFrequency { real, imaginary })
}

/// The greatest magnitude of the remainder on a finite panel.
pub(super) fn remainder<S: Decimal>(dead_time: &DeadTime<S>, range: PanelRange, angle: f64) -> S {
    let [least, most] = ends(dead_time);
    let angle = S::decimal(angle);
    let beyond = (S::decimal(range.to) * most - angle).abs();
    let before = (S::decimal(range.from) * least - angle).abs();
    let turn = beyond.maximum(before);
    (1..=dead_time.terms).fold(S::from(1.0), |product, k| product * turn / S::from(k as f64))
}

/// The least and the greatest dead time of a box, from the individual terms.
pub(super) fn ends<S: Decimal>(dead_time: &DeadTime<S>) -> [S; 2] {
    let zero = S::from(0.0);
    dead_time.value.terms().fold([zero; 2], |[least, most], (exponents, value)| {
        match exponents.iter().all(|exponent| *exponent == 0) {
            true => [least + value, most + value],
            false => [least + value.minimum(zero), most + value.maximum(zero)],
        }
    })
}

/// Accuracy of the cosine and the sine of an angle, in units of one and of the angle.
const TRIGONOMETRIC_ERROR: f64 = 4.0 * f64::EPSILON;

/// The cosine and the sine of every angle of an interval: neither changes faster than the angle,
/// and the functions of the library have smaller errors than assumed here.
pub(super) fn enclosed_cosine_and_sine(angle: Interval) -> [Interval; 2] {
    let middle = angle.middle();
    let beside = (angle - Interval::from(middle)).abs().high();
    let error = (TRIGONOMETRIC_ERROR * (1.0 + middle.abs()) + beside).next_up();
    f64::cosine_and_sine(middle).map(|value| match error.is_finite() {
        true => Interval::new((value - error).next_down(), (value + error).next_up()),
        false => Interval::new(-1.0, 1.0),
    })
}
