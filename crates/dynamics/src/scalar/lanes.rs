use std::ops::{Add, Div, Mul, Neg, Sub};

use super::Scalar;
use super::exponential::exponential;
use crate::portable;

/// Lanes of a vector: two registers of the widest common kind, which hide the latency of divisions
/// and roots.
pub const LANES: usize = 4;

/// Parallel numbers, every operation on all of them at once: one equation for as many machines as
/// there are lanes.
///
/// A lane's result is bit-identical to that of a plain number: each operation is the plain one,
/// lane by lane, which the compiler vectorises. The lanes are written out: with loops in equations
/// of thousands of operations, compilation takes several times as long.
///
/// # Example
/// ```
/// use phea_dynamics::scalar::{Lanes, Scalar};
/// let drops = Lanes([4.0, 9.0, 16.0, 25.0]);
/// assert_eq!(drops.sqrt(), Lanes([2.0, 3.0, 4.0, 5.0]));
/// let limited = Scalar::select(drops.less_than(Lanes::from(5.0)), drops, Lanes::from(5.0));
/// assert_eq!(limited, Lanes([4.0, 5.0, 5.0, 5.0]));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(align(32))]
pub struct Lanes(pub [f64; LANES]);

impl From<f64> for Lanes {
    #[inline(always)]
    fn from(value: f64) -> Self {
        Lanes([value; LANES])
    }
}

impl Lanes {
    #[inline(always)]
    fn each(self, of: impl Fn(f64) -> f64) -> Self {
        let [a, b, c, d] = self.0;
        Lanes([of(a), of(b), of(c), of(d)])
    }
}

impl Add for Lanes {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        Lanes([a + e, b + f, c + g, d + h])
    }
}

impl Sub for Lanes {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        Lanes([a - e, b - f, c - g, d - h])
    }
}

impl Mul for Lanes {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        Lanes([a * e, b * f, c * g, d * h])
    }
}

impl Div for Lanes {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        Lanes([a / e, b / f, c / g, d / h])
    }
}

impl Neg for Lanes {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.each(|a| -a)
    }
}

impl Scalar for Lanes {
    type Mask = [bool; LANES];

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.each(f64::sqrt)
    }
    #[inline(always)]
    fn exp(self) -> Self {
        self.each(exponential)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        self.each(portable::ln)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.each(f64::abs)
    }
    #[inline(always)]
    fn less_than(self, other: Self) -> [bool; LANES] {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        [a < e, b < f, c < g, d < h]
    }
    #[inline(always)]
    fn select(mask: [bool; LANES], if_true: Self, if_false: Self) -> Self {
        let one = |lane: usize| if mask[lane] { if_true.0[lane] } else { if_false.0[lane] };
        Lanes([one(0), one(1), one(2), one(3)])
    }
}
