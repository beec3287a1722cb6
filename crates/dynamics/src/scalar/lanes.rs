use std::ops::{Add, Div, Mul, Neg, Sub};

use super::Scalar;
use super::exponential::exponential;
use crate::portable;

/// L numbers side by side, every operation on all of them at once: the same equation for L
/// machines.
///
/// A lane's result has the same bits as the plain number's: each operation is the plain one, lane
/// by lane, and the compiler makes vector instructions of it.
///
/// # Example
/// ```
/// use phea_dynamics::scalar::{Lanes, Scalar};
/// let drops = Lanes([4.0, 9.0]);
/// assert_eq!(drops.sqrt(), Lanes([2.0, 3.0]));
/// let limited = Scalar::select(drops.less_than(Lanes::from(5.0)), drops, Lanes::from(5.0));
/// assert_eq!(limited, Lanes([4.0, 5.0]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(32))]
pub struct Lanes<const L: usize>(pub [f64; L]);

impl<const L: usize> From<f64> for Lanes<L> {
    #[inline(always)]
    fn from(value: f64) -> Self {
        Lanes([value; L])
    }
}

impl<const L: usize> Lanes<L> {
    #[inline(always)]
    fn each(self, function: impl Fn(f64) -> f64) -> Self {
        let mut lanes = self.0;
        for lane in &mut lanes {
            *lane = function(*lane);
        }
        Lanes(lanes)
    }

    #[inline(always)]
    fn pairs(self, other: Self, function: impl Fn(f64, f64) -> f64) -> Self {
        let mut lanes = self.0;
        for (lane, with) in lanes.iter_mut().zip(other.0) {
            *lane = function(*lane, with);
        }
        Lanes(lanes)
    }
}

impl<const L: usize> Add for Lanes<L> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.pairs(other, |a, b| a + b)
    }
}

impl<const L: usize> Sub for Lanes<L> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.pairs(other, |a, b| a - b)
    }
}

impl<const L: usize> Mul for Lanes<L> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.pairs(other, |a, b| a * b)
    }
}

impl<const L: usize> Div for Lanes<L> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.pairs(other, |a, b| a / b)
    }
}

impl<const L: usize> Neg for Lanes<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.each(|a| -a)
    }
}

impl<const L: usize> Scalar for Lanes<L> {
    type Mask = [bool; L];

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
    fn less_than(self, other: Self) -> [bool; L] {
        let mut mask = [false; L];
        for ((flag, a), b) in mask.iter_mut().zip(self.0).zip(other.0) {
            *flag = a < b;
        }
        mask
    }
    #[inline(always)]
    fn select(mask: [bool; L], if_true: Self, if_false: Self) -> Self {
        let mut lanes = if_false.0;
        for ((lane, flag), value) in lanes.iter_mut().zip(mask).zip(if_true.0) {
            *lane = if flag { value } else { *lane };
        }
        Lanes(lanes)
    }
}
