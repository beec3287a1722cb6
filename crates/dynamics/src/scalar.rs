//! The number that model equations are written over.
//!
//! A model equation is one generic function over [`Scalar`] and never branches on a value: a choice between two
//! formulas is [`Scalar::less_than`] followed by [`Scalar::select`]. So the same text serves plain numbers
//! (simulation), [`Lanes`] (ensembles), [`Dual`] numbers (exact Jacobians), [`Dependence`] (their pattern) and
//! [`crate::expression::Recorded`] expressions (uncertain plants, generated code), and leaves room for intervals, whose
//! comparison is not a `bool`.
//!
//! # Example
//! One equation, three users:
//! ```
//! use phea_dynamics::expression::Expression;
//! use phea_dynamics::scalar::{Dual, Scalar};
//! fn orifice<S: Scalar>(coefficient: S, drop: S) -> S {
//!     coefficient * drop.sqrt()
//! }
//! assert_eq!(orifice(2.0, 9.0), 6.0);
//! let slope = orifice(Dual::constant(2.0), Dual::<1>::variable(9.0, 0)).gradient()[0];
//! assert_eq!(slope, 1.0 / 3.0);
//! let recorded = Expression::record(&["coefficient", "drop"], |p| vec![orifice(p[0], p[1])]);
//! assert_eq!(recorded.evaluate(&[2.0, 9.0]), vec![6.0]);
//! ```

mod dependence;
mod dual;
mod exponential;
mod lanes;

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

pub use dependence::Dependence;
pub use dual::Dual;
pub use lanes::Lanes;

use crate::portable;

/// A number with the operations that model equations may use, and no others.
pub trait Scalar:
    Copy
    + Debug
    + From<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The outcome of a comparison: `bool` for one number, one flag a lane for lanes, three-valued for intervals.
    type Mask: Copy;

    /// Square root.
    fn sqrt(self) -> Self;
    /// Natural exponential.
    fn exp(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Magnitude |x|; its derivative at zero is taken as zero.
    fn abs(self) -> Self;
    /// Whether `self < other`.
    fn less_than(self, other: Self) -> Self::Mask;
    /// `if_true` where the mask holds, `if_false` elsewhere. Both are evaluated.
    fn select(mask: Self::Mask, if_true: Self, if_false: Self) -> Self;

    /// The larger of two numbers.
    fn maximum(self, other: Self) -> Self {
        Self::select(self.less_than(other), other, self)
    }

    /// The smaller of two numbers.
    fn minimum(self, other: Self) -> Self {
        Self::select(other.less_than(self), other, self)
    }

    /// The product with a plain number.
    #[inline(always)]
    fn times(self, factor: f64) -> Self {
        self * Self::from(factor)
    }

    /// x², cheaper and more exact than a power.
    fn squared(self) -> Self {
        self * self
    }
}

impl Scalar for f64 {
    type Mask = bool;

    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn exp(self) -> Self {
        exponential::exponential(self)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        portable::ln(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn less_than(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn select(mask: bool, if_true: Self, if_false: Self) -> Self {
        if mask { if_true } else { if_false }
    }
}
