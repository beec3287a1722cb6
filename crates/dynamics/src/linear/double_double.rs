//! Numbers of twice the working precision (about 32 digits), for sums that nearly cancel.
//!
//! A number is the unevaluated sum of two `f64`; the operations are those of Dekker (1971) and
//! Knuth, with a fused multiply-add for the error of a product. Invalid beyond about 1e290.

use num_complex::Complex64;
use std::ops::{Add, Mul, Neg, Sub};

/// high + low, with |low| at most half a unit in the last place of high.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct DoubleDouble {
    pub(crate) high: f64,
    pub(crate) low: f64,
}

impl DoubleDouble {
    pub(crate) const ZERO: DoubleDouble = DoubleDouble { high: 0.0, low: 0.0 };

    /// Sum a + b without error.
    #[inline(always)]
    pub(crate) fn sum_of(a: f64, b: f64) -> Self {
        let high = a + b;
        let part = high - a;
        DoubleDouble { high, low: (a - (high - part)) + (b - part) }
    }

    /// Product a b without error.
    #[inline(always)]
    pub(crate) fn product_of(a: f64, b: f64) -> Self {
        let high = a * b;
        DoubleDouble { high, low: a.mul_add(b, -high) }
    }

    /// The nearest `f64`.
    #[inline(always)]
    pub(crate) fn value(self) -> f64 {
        self.high + self.low
    }

    #[inline(always)]
    pub(crate) fn abs(self) -> Self {
        if self.high < 0.0 { -self } else { self }
    }

    /// Quotient by an `f64`.
    #[inline(always)]
    pub(crate) fn divided_by(self, divisor: f64) -> Self {
        self.divided_by_wide(divisor.into())
    }

    /// Quotient, accurate to about thirty digits.
    #[inline(always)]
    pub(crate) fn divided_by_wide(self, divisor: Self) -> Self {
        let first = self.high / divisor.high;
        let rest = self - divisor * DoubleDouble::from(first);
        DoubleDouble::normalised(first, rest.value() / divisor.high)
    }

    /// Number times a power of two.
    #[inline(always)]
    pub(crate) fn scaled(self, power_of_two: f64) -> Self {
        DoubleDouble { high: self.high * power_of_two, low: self.low * power_of_two }
    }

    #[inline(always)]
    fn normalised(high: f64, low: f64) -> Self {
        let sum = high + low;
        DoubleDouble { high: sum, low: low - (sum - high) }
    }
}

impl From<f64> for DoubleDouble {
    #[inline(always)]
    fn from(value: f64) -> Self {
        DoubleDouble { high: value, low: 0.0 }
    }
}

impl Add for DoubleDouble {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let high = DoubleDouble::sum_of(self.high, other.high);
        let low = DoubleDouble::sum_of(self.low, other.low);
        let first = DoubleDouble::normalised(high.high, high.low + low.high);
        DoubleDouble::normalised(first.high, first.low + low.low)
    }
}

impl Neg for DoubleDouble {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        DoubleDouble { high: -self.high, low: -self.low }
    }
}

impl Sub for DoubleDouble {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + (-other)
    }
}

impl Mul for DoubleDouble {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let product = DoubleDouble::product_of(self.high, other.high);
        let cross = self.high * other.low + self.low * other.high;
        DoubleDouble::normalised(product.high, product.low + cross)
    }
}

/// A complex number of twice the working precision.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ComplexDoubleDouble {
    pub(crate) re: DoubleDouble,
    pub(crate) im: DoubleDouble,
}

impl ComplexDoubleDouble {
    /// Difference z - root without error.
    #[inline(always)]
    pub(crate) fn difference_of(z: Complex64, root: Complex64) -> Self {
        ComplexDoubleDouble {
            re: DoubleDouble::sum_of(z.re, -root.re),
            im: DoubleDouble::sum_of(z.im, -root.im),
        }
    }

    /// Number times a power of two.
    #[inline(always)]
    pub(crate) fn scaled(self, power_of_two: f64) -> Self {
        ComplexDoubleDouble { re: self.re.scaled(power_of_two), im: self.im.scaled(power_of_two) }
    }

    /// Number times a real one: all digits of the complex product, at half the work.
    #[inline(always)]
    pub(crate) fn times_real(self, factor: f64) -> Self {
        self.times_wide(DoubleDouble::from(factor))
    }

    /// Number times a real one of twice the working precision.
    #[inline(always)]
    pub(crate) fn times_wide(self, factor: DoubleDouble) -> Self {
        ComplexDoubleDouble { re: factor * self.re, im: factor * self.im }
    }

    /// Quotient, accurate to about thirty digits.
    #[inline(always)]
    pub(crate) fn divided_by(self, divisor: Self) -> Self {
        let squares = divisor.re * divisor.re + divisor.im * divisor.im;
        let conjugate = ComplexDoubleDouble { re: divisor.re, im: -divisor.im };
        let product = self * conjugate;
        ComplexDoubleDouble {
            re: product.re.divided_by_wide(squares),
            im: product.im.divided_by_wide(squares),
        }
    }

    /// Nearest ordinary complex number.
    #[inline(always)]
    pub(crate) fn value(self) -> Complex64 {
        Complex64::new(self.re.value(), self.im.value())
    }
}

impl From<f64> for ComplexDoubleDouble {
    #[inline(always)]
    fn from(value: f64) -> Self {
        ComplexDoubleDouble { re: value.into(), im: DoubleDouble::ZERO }
    }
}

impl From<DoubleDouble> for ComplexDoubleDouble {
    #[inline(always)]
    fn from(value: DoubleDouble) -> Self {
        ComplexDoubleDouble { re: value, im: DoubleDouble::ZERO }
    }
}

impl From<Complex64> for ComplexDoubleDouble {
    #[inline(always)]
    fn from(value: Complex64) -> Self {
        ComplexDoubleDouble { re: value.re.into(), im: value.im.into() }
    }
}

impl Add for ComplexDoubleDouble {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        ComplexDoubleDouble { re: self.re + other.re, im: self.im + other.im }
    }
}

impl Sub for ComplexDoubleDouble {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        ComplexDoubleDouble { re: self.re - other.re, im: self.im - other.im }
    }
}

impl Mul for ComplexDoubleDouble {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        ComplexDoubleDouble {
            re: self.re * other.re - self.im * other.im,
            im: self.re * other.im + self.im * other.re,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_working_precision_loses_is_kept() {
        // ORIGIN: analytic. (1 + h^2) - 1 = h^2 and (1 + h)^2 - (1 + 2 h) = h^2 for h = 2^-30.
        let h = 1.0 / f64::from(1_u32 << 30);
        let tiny = DoubleDouble::sum_of(1.0, h * h) - DoubleDouble::from(1.0);
        assert_eq!(tiny.value(), h * h);
        let square = DoubleDouble::product_of(1.0 + h, 1.0 + h) - DoubleDouble::sum_of(1.0, 2.0 * h);
        assert_eq!(square.value(), h * h);
        let third = DoubleDouble::from(1.0 / 3.0) * DoubleDouble::from(3.0) - DoubleDouble::from(1.0);
        assert_eq!(third.value(), -f64::EPSILON / 4.0);
    }

    #[test]
    fn a_real_factor_has_no_imaginary_part() {
        let mut z = ComplexDoubleDouble::from(Complex64::new(0.3, -7.1e-5));
        for factor in [1.0 / 3.0, -1e9, 2.7e-4, 5.1, -1.9e-3, 0.7] {
            let product = ComplexDoubleDouble::from(factor) * z;
            z = z.times_real(factor);
            assert_eq!(z, product);
        }
    }
}
