use std::ops::{Add, Div, Mul, Neg, Sub};

use num_complex::Complex64;

use super::{Analytic, SMALL, series, slope_of_series};
use crate::portable;

/// A disc of the complex plane. The result of an operation on discs contains the results for all of
/// their points.
///
/// ```text
/// (a, r) + (b, q) = (a + b, r + q)
/// (a, r)(b, q) = (a b, |a| q + |b| r + r q)
/// 1/(a, r) = (conj a, r)/(|a|^2 - r^2)                 |a| > r; otherwise the whole plane
/// exp (a, r) = (e^a, |e^a| (e^r - 1))
/// ```
///
/// Every operation adds a bound of its rounding error to the radius: eight units in the last place.
/// Source: Gargantini and Henrici (1971), Numerische Mathematik 18.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    centre: Complex64,
    radius: f64,
}

/// Bound of the rounding error of one operation, relative to its result.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

impl Disc {
    /// The whole plane.
    pub const WHOLE: Disc = Disc { centre: Complex64::ZERO, radius: f64::INFINITY };

    /// A disc; the whole plane if the centre is not finite or the radius is not a non-negative
    /// number.
    pub fn new(centre: Complex64, radius: f64) -> Disc {
        if centre.is_finite() && radius >= 0.0 { Disc { centre, radius } } else { Disc::WHOLE }
    }

    /// Smallest disc that contains j w for every w between two frequencies in rad/s.
    pub fn of_frequencies([from, to]: [f64; 2]) -> Disc {
        let middle = 0.5 * (from + to);
        let radius = (to - middle).abs().max((middle - from).abs());
        Disc::new(Complex64::new(0.0, middle), radius * (1.0 + ROUNDING))
    }

    /// Centre of the disc.
    pub fn centre(self) -> Complex64 {
        self.centre
    }

    /// Radius; infinite for the whole plane.
    pub fn radius(self) -> f64 {
        self.radius
    }

    /// True if the disc contains the point.
    pub fn contains(self, point: Complex64) -> bool {
        portable::magnitude(point - self.centre) <= self.radius
    }

    /// Smallest distance of a point of the disc from zero; 0 if the disc contains zero.
    pub fn distance(self) -> f64 {
        (portable::magnitude(self.centre) * (1.0 - ROUNDING) - self.radius).max(0.0)
    }

    /// Derivative of (1 - e^(-z))/z, given the value of that function.
    pub(super) fn slope_of_mean_of_decay(self, mean: Disc) -> Disc {
        if portable::magnitude(self.centre) + self.radius < SMALL {
            let found = slope_of_series(self);
            // adds the truncation error of the series
            return Disc::rounded(found.centre, found.radius, 1.0);
        }
        ((-self).exponential() - mean) / self
    }

    /// Result of an operation whose centre is accurate to `size` times the rounding.
    fn rounded(centre: Complex64, radius: f64, size: f64) -> Disc {
        Disc::new(centre, radius * (1.0 + ROUNDING) + ROUNDING * size)
    }

    fn inverse(self) -> Disc {
        let square = self.centre.norm_sqr();
        let left = square - self.radius * self.radius;
        if left.is_nan() || left <= ROUNDING * square {
            return Disc::WHOLE;
        }
        let size = portable::magnitude(self.centre) / left;
        // the relative rounding error of the denominator grows where radius and centre are nearly
        // equal
        let relative = 1.0 + square / left;
        Disc::rounded(
            self.centre.conj() / left,
            self.radius / left * (1.0 + ROUNDING * relative),
            size * relative,
        )
    }
}

impl From<f64> for Disc {
    fn from(value: f64) -> Disc {
        Disc::new(Complex64::new(value, 0.0), 0.0)
    }
}

impl From<Complex64> for Disc {
    fn from(value: Complex64) -> Disc {
        Disc::new(value, 0.0)
    }
}

impl Add for Disc {
    type Output = Disc;
    fn add(self, other: Disc) -> Disc {
        let centre = self.centre + other.centre;
        Disc::rounded(centre, self.radius + other.radius, portable::magnitude(centre))
    }
}

impl Sub for Disc {
    type Output = Disc;
    fn sub(self, other: Disc) -> Disc {
        self + -other
    }
}

impl Neg for Disc {
    type Output = Disc;
    fn neg(self) -> Disc {
        Disc { centre: -self.centre, radius: self.radius }
    }
}

impl Mul for Disc {
    type Output = Disc;
    fn mul(self, other: Disc) -> Disc {
        let (own, others) = (portable::magnitude(self.centre), portable::magnitude(other.centre));
        let radius = own * other.radius + self.radius * (others + other.radius);
        Disc::rounded(self.centre * other.centre, radius, own * others)
    }
}

impl Div for Disc {
    type Output = Disc;
    #[expect(clippy::suspicious_arithmetic_impl, reason = "a quotient is a product with the inverse")]
    fn div(self, other: Disc) -> Disc {
        self * other.inverse()
    }
}

impl Analytic for Disc {
    fn scaled(self, factor: f64) -> Disc {
        let centre = self.centre * factor;
        Disc::rounded(centre, self.radius * factor.abs(), portable::magnitude(centre))
    }

    fn exponential(self) -> Disc {
        let centre = portable::exp_complex(self.centre);
        let size = portable::magnitude(centre);
        let grown = if self.radius < 1e-3 {
            // e^r - 1 without cancellation
            self.radius * (1.0 + self.radius)
        } else {
            portable::exp(self.radius) - 1.0
        };
        // the argument of sine and cosine is rounded as well
        Disc::rounded(centre, size * grown, size * (1.0 + portable::magnitude(self.centre)))
    }

    fn mean_of_decay(self) -> Disc {
        if portable::magnitude(self.centre) + self.radius < SMALL {
            let found = series(self);
            // adds the truncation error of the series
            return Disc::rounded(found.centre, found.radius, 1.0);
        }
        (Disc::from(1.0) - (-self).exponential()) / self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::uniform;

    fn drawn(state: &mut u64, size: f64) -> Complex64 {
        Complex64::new(size * (2.0 * uniform(state) - 1.0), size * (2.0 * uniform(state) - 1.0))
    }

    fn within(disc: Disc, state: &mut u64) -> Complex64 {
        let angle = 2.0 * std::f64::consts::PI * uniform(state);
        let turn = Complex64::new(portable::cos(angle), portable::sin(angle));
        disc.centre + turn * (disc.radius * uniform(state).sqrt())
    }

    /// Sums, products, quotients and the other results of points of two discs are in the resulting
    /// discs.
    #[test]
    fn results_hold_those_of_every_point() {
        let mut state = 4;
        for _ in 0..2000 {
            let (one, other) = (drawn(&mut state, 3.0), drawn(&mut state, 3.0));
            let discs = [Disc::new(one, uniform(&mut state)), Disc::new(other, uniform(&mut state))];
            for _ in 0..10 {
                let points = discs.map(|disc| within(disc, &mut state));
                let [p, q] = points;
                let [a, b] = discs;
                assert!((a + b).contains(p + q) && (a - b).contains(p - q));
                assert!((a * b).contains(p * q) && (a / b).contains(p / q));
                assert!(a.exponential().contains(p.exponential()));
                assert!(a.mean_of_decay().contains(p.mean_of_decay()));
                assert!(portable::magnitude(p) >= a.distance());
            }
        }
    }

    /// ORIGIN: analytic; the image of a circle under 1/z is a circle, so that an inverse cannot be
    /// smaller.
    #[test]
    fn an_inverse_is_the_image_of_the_disc() {
        let disc = Disc::new(Complex64::new(3.0, 0.0), 1.0);
        let inverse = Disc::from(1.0) / disc;
        assert!((inverse.centre.re - 3.0 / 8.0).abs() < 1e-15 && (inverse.radius - 1.0 / 8.0).abs() < 1e-14);
        assert_eq!(Disc::from(1.0) / Disc::new(Complex64::ONE, 1.0), Disc::WHOLE);
        assert_eq!((Disc::WHOLE * Disc::from(0.0)).distance(), 0.0);
    }

    /// ORIGIN: analytic; the series and the quotient agree at the transition between them.
    #[test]
    fn the_mean_of_a_decay_is_smooth() {
        for size in [1e-9, 0.1, 0.499_999, 0.500_001] {
            let z = Complex64::new(0.6 * size, 0.8 * size);
            let step = Complex64::new(1.0, 0.0) - portable::exp_complex(-z);
            assert!(portable::magnitude(z.mean_of_decay() * z - step) < 1e-15);
        }
    }
}
