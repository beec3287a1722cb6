//! Number type of the model equations.
//!
//! A model equation is one generic function over [`Scalar`] and never branches on a value: a choice
//! between two formulas is [`Scalar::less_than`] followed by [`Scalar::select`]. So one text serves
//! plain numbers (simulation), [`Lanes`] (ensembles), [`Dual`] numbers (exact Jacobians),
//! [`Dependence`] (their pattern) and [`crate::expression::Recorded`] expressions (uncertain
//! plants, generated code) and [`Interval`]s, whose comparison is not a `bool`.
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
mod interval;
mod lanes;
mod parameters;

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

pub use dependence::Dependence;
pub use dual::Dual;
pub use interval::Interval;
pub use lanes::{LANES, Lanes};
pub use parameters::Parameters;

use crate::portable;

/// Number with the operations that model equations may use, and no others.
pub trait Scalar:
    Copy
    + Debug
    + Default
    + PartialEq
    + From<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Result of a comparison: `bool` for one number, one flag per lane for lanes, three-valued for
    /// intervals.
    type Mask: Copy;

    /// Square root.
    fn sqrt(self) -> Self;
    /// Natural exponential.
    fn exp(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Magnitude |x|; its derivative at zero is taken as zero.
    fn abs(self) -> Self;
    /// Mask of `self < other`.
    fn less_than(self, other: Self) -> Self::Mask;
    /// `if_true` if the mask holds, `if_false` elsewhere. Both are evaluated.
    fn select(mask: Self::Mask, if_true: Self, if_false: Self) -> Self;

    /// Larger of two numbers.
    #[inline(always)]
    fn maximum(self, other: Self) -> Self {
        Self::select(self.less_than(other), other, self)
    }

    /// Smaller of two numbers.
    #[inline(always)]
    fn minimum(self, other: Self) -> Self {
        Self::select(other.less_than(self), other, self)
    }

    /// Product with a plain number.
    #[inline(always)]
    fn times(self, factor: f64) -> Self {
        self * Self::from(factor)
    }

    /// Square x², cheaper and more exact than a power.
    #[inline(always)]
    fn squared(self) -> Self {
        self * self
    }

    /// Function of few numbers.
    ///
    /// Equal to the function itself; but [`Dual`] numbers compute its derivatives with respect to
    /// its own variables and convert them to theirs once, by the chain rule.
    ///
    /// ```text
    /// dy_m/dx = sum over k of (df_m/du_k) (du_k/dx)
    /// ```
    #[inline(always)]
    fn local<P: Copy, const K: usize, const M: usize>(
        function: &impl LocalFunction<P, K, M>,
        variables: [Self; K],
    ) -> [Self; M]
    where
        Self: From<P>,
    {
        function.at(variables, Self::from)
    }
}

/// Function of K numbers with M results, its parameters of type P: a part of a model that depends
/// on few of its variables.
///
/// # Example
/// An orifice between two of many pressures:
/// ```
/// use phea_dynamics::scalar::{Dual, LocalFunction, Scalar};
/// struct Orifice {
///     coefficient: f64,
/// }
/// impl LocalFunction<f64, 2, 1> for Orifice {
///     fn at<T: Scalar>(&self, [above, below]: [T; 2], constant: impl Fn(f64) -> T + Copy) -> [T; 1] {
///         [constant(self.coefficient) * (above - below).sqrt()]
///     }
/// }
/// let orifice = Orifice { coefficient: 2.0 };
/// assert_eq!(f64::local(&orifice, [13.0, 4.0]), [6.0]);
/// // both pressures rise with the third of three variables, one of them twice as fast
/// let above = Dual::<3>::new(13.0, [0.0, 0.0, 2.0]);
/// let [flow] = Dual::local(&orifice, [above, Dual::variable(4.0, 2)]);
/// assert_eq!(flow.gradient(), &[0.0, 0.0, 1.0 / 3.0]);
/// ```
pub trait LocalFunction<P, const K: usize, const M: usize> {
    /// Results over any scalar; `constant` converts a parameter.
    fn at<T: Scalar>(&self, variables: [T; K], constant: impl Fn(P) -> T + Copy) -> [T; M];
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
