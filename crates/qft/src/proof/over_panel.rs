//! Functions of only the frequency over a finite panel: a polynomial, and a remainder. Sampled
//! controllers, holds and pure delays are such functions.
//!
//! ```text
//! w = middle + half y,  y in [-1, 1],      f(w) = sum over k < m of f_k y^k + r,   |r| <= rest
//!
//! e^(-j w theta)                  f_k = e^(-j a) (-j b)^k/k!                         a = middle theta, b = half theta, rest = b^m/m!
//! (1 - e^(-j w T))/(j w T)        f_k = (-j b)^k/k! I_k,  I_k = integral over [0, 1] of x^k e^(-j a x)     rest = b^m/m!, theta = T
//! W (w/v)^alpha                   f_k = W (middle/v)^alpha C(alpha, k) u^k           u = half/middle, rest: |f_m|/(1 - u max(1, (m + |alpha|)/(m + 1)))
//! ```
//!
//! C(alpha, k + 1)/C(alpha, k) = (alpha - k)/(k + 1), whose magnitude from k = m on is not greater
//! than that maximum.

use super::dead_time::InFrequency;
use super::part::Straight;
use super::polynomial::{BoxPolynomial, Decimal, InS};

/// Number of terms of the series of I_k.
const HOLD_TERMS: usize = 40;
/// Bound on the sum of the omitted terms: less than 2 a^40/40!, which is 2e-27 for the angle a =
/// 3.3, slightly more than half a turn.
const HOLD_REST: f64 = 1e-20;

/// A complex number.
pub(super) type Complex<S> = [S; 2];

/// A function of the frequency on a panel.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct OverPanel<S> {
    /// Coefficients of the powers of y.
    coefficients: Vec<Complex<S>>,
    /// Largest difference between the sum and the function.
    rest: S,
}

/// A panel as its middle and half its width, with the number of retained terms.
#[derive(Clone, Copy, Debug)]
pub(super) struct Middle<S> {
    middle: S,
    half: S,
    terms: usize,
}

impl<S: Decimal> Middle<S> {
    pub(super) fn of([from, to]: [S; 2], terms: usize) -> Middle<S> {
        Middle { middle: (from + to).times(0.5), half: (to - from).times(0.5), terms }
    }

    /// Delay e^(-j w theta).
    pub(super) fn turned(self, theta: S) -> OverPanel<S> {
        let [cosine, sine] = S::cosine_and_sine(self.middle * theta);
        let start = [cosine, -sine];
        let (powers, rest) = self.powers(theta);
        OverPanel { coefficients: powers.into_iter().map(|power| product(start, power)).collect(), rest }
    }

    /// Function zeta = e^(j w T) - 1.
    pub(super) fn step(self, sample_time_s: S) -> OverPanel<S> {
        let mut turned = self.turned(-sample_time_s);
        if let Some([real, _]) = turned.coefficients.first_mut() {
            *real = *real - S::from(1.0);
        }
        turned
    }

    /// Hold (1 - e^(-j w T))/(j w T).
    pub(super) fn hold(self, sample_time_s: S) -> OverPanel<S> {
        let turn = self.middle * sample_time_s;
        let (powers, rest) = self.powers(sample_time_s);
        let each = powers.into_iter().enumerate();
        let coefficients = each.map(|(k, power)| product(moment(k, turn), power)).collect();
        OverPanel { coefficients, rest }
    }

    /// A power of the frequency, on a panel where it is positive.
    pub(super) fn straight(self, Straight { from, to }: Straight) -> OverPanel<S> {
        let [(low, low_value), (high, high_value)] =
            [from, to].map(|(w, value)| (S::decimal(w), S::decimal(value)));
        let exponent = (high_value / low_value).ln() / (high / low).ln();
        let ratio = self.half / self.middle;
        let mut term = low_value * (exponent * (self.middle / low).ln()).exp();
        let mut coefficients = Vec::with_capacity(self.terms);
        for k in 0..self.terms {
            coefficients.push([term, S::from(0.0)]);
            term = term * ratio * (exponent - S::from(k as f64)) / S::from((k + 1) as f64);
        }
        let degree = S::from(self.terms as f64);
        let growth = S::from(1.0).maximum((degree + exponent.abs()) / (degree + S::from(1.0)));
        let left = S::from(1.0) - ratio * growth;
        let rest = if left.least() > 0.0 { term.abs() / left } else { S::from(f64::INFINITY) };
        OverPanel { coefficients, rest }
    }

    /// Terms (-j b)^k/k!, and the remainder.
    fn powers(self, theta: S) -> (Vec<Complex<S>>, S) {
        let turn = self.half * theta;
        let mut size = S::from(1.0);
        let mut out = Vec::with_capacity(self.terms);
        for k in 0..self.terms {
            let zero = S::from(0.0);
            out.push(match k % 4 {
                0 => [size, zero],
                1 => [zero, -size],
                2 => [-size, zero],
                _ => [zero, size],
            });
            size = size * turn / S::from((k + 1) as f64);
        }
        (out, size.abs())
    }

    /// A number.
    pub(super) fn constant(self, value: S) -> OverPanel<S> {
        OverPanel { coefficients: vec![[value, S::from(0.0)]], rest: S::from(0.0) }
    }

    /// A polynomial with these decimals, highest power first, applied to a function.
    pub(super) fn polynomial(self, coefficients: &[f64], of: &OverPanel<S>) -> OverPanel<S> {
        coefficients.iter().fold(self.constant(S::from(0.0)), |sum, &coefficient| {
            let mut sum = self.product(&sum, of);
            let own = if coefficient == 0.0 { S::from(0.0) } else { S::decimal(coefficient) };
            if let Some([real, _]) = sum.coefficients.first_mut() {
                *real = *real + own;
            }
            sum
        })
    }

    /// The product; terms beyond the retained ones are added to the remainder.
    pub(super) fn product(self, one: &OverPanel<S>, other: &OverPanel<S>) -> OverPanel<S> {
        let length = (one.coefficients.len() + other.coefficients.len()).saturating_sub(1);
        let mut all = vec![[S::from(0.0); 2]; length];
        for (index, &a) in one.coefficients.iter().enumerate() {
            for (slot, &b) in all.iter_mut().skip(index).zip(&other.coefficients) {
                *slot = sum(*slot, product(a, b));
            }
        }
        let beyond = all.iter().skip(self.terms).fold(S::from(0.0), |sum, &one| sum + size(one));
        all.truncate(self.terms);
        let rest = one.rest * other.size() + one.size() * other.rest + one.rest * other.rest + beyond;
        OverPanel { coefficients: all, rest }
    }
}

impl<S: Decimal> OverPanel<S> {
    /// Largest difference between the sum and the function.
    pub(super) fn rest(&self) -> S {
        self.rest
    }

    /// Largest magnitude of the sum.
    pub(super) fn size(&self) -> S {
        self.coefficients.iter().fold(S::from(0.0), |sum, &one| sum + size(one))
    }

    /// The sum in powers of x, y = 2 x - 1.
    pub(super) fn along(&self) -> InFrequency<S> {
        let part =
            |own: usize| InS(self.coefficients.iter().map(|one| BoxPolynomial::constant(one[own])).collect());
        InFrequency { real: part(0), imaginary: part(1) }.along(S::from(-1.0), S::from(2.0))
    }

    /// The value if the panel is a single frequency.
    pub(super) fn value(&self) -> Complex<S> {
        self.coefficients.first().copied().unwrap_or([S::from(0.0); 2])
    }
}

/// The integral of x^k e^(-j a x) from 0 to 1, by its series.
///
/// ```text
/// I_k = sum over n of (-j a)^n/(n! (k + n + 1))
/// ```
fn moment<S: Decimal>(k: usize, turn: S) -> Complex<S> {
    let mut power = [S::from(1.0), S::from(0.0)];
    let mut out = [S::uncertain(HOLD_REST); 2];
    for n in 0..HOLD_TERMS {
        let fraction = S::from(1.0) / S::from((k + n + 1) as f64);
        out = sum(out, [power[0] * fraction, power[1] * fraction]);
        let factor = turn / S::from((n + 1) as f64);
        power = [power[1] * factor, -(power[0] * factor)];
    }
    out
}

pub(super) fn sum<S: Decimal>(a: Complex<S>, b: Complex<S>) -> Complex<S> {
    [a[0] + b[0], a[1] + b[1]]
}

pub(super) fn product<S: Decimal>(a: Complex<S>, b: Complex<S>) -> Complex<S> {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

/// Upper bound of the magnitude.
pub(super) fn size<S: Decimal>(value: Complex<S>) -> S {
    value[0].abs() + value[1].abs()
}
