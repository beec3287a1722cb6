//! Types over which a response is written once and evaluated at one frequency or over an interval
//! of frequencies.

mod disc;
mod jet;

use std::ops::{Add, Div, Mul, Neg, Sub};

use num_complex::Complex64;

use crate::portable;

pub use disc::Disc;
pub use jet::Jet;

/// A complex number, or a set of complex numbers, with sums, products, quotients and the
/// exponential.
///
/// # Example
/// One function, evaluated over either type, gives the response at a frequency or a disc that
/// contains the response at every frequency of an interval.
/// ```
/// use num_complex::Complex64;
/// use phea_dynamics::analytic::{Analytic, Disc};
/// fn lag<A: Analytic>(s: A) -> A {
///     A::from(1.0) / (s.scaled(0.5) + A::from(1.0))
/// }
/// let held = lag(Disc::of_frequencies([1.0, 1.1]));
/// let inside = lag(Complex64::new(0.0, 1.03));
/// assert!(held.contains(inside) && held.radius() < 0.04);
/// ```
pub trait Analytic:
    Copy
    + From<f64>
    + From<Complex64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Product with a real number.
    fn scaled(self, factor: f64) -> Self;
    /// Exponential: e to this power.
    fn exponential(self) -> Self;
    /// (1 - e^(-z))/z, which is 1 at zero.
    fn mean_of_decay(self) -> Self;
}

/// Below this magnitude (1 - e^(-z))/z is computed from its series.
const SMALL: f64 = 0.5;
/// Number of terms of the series: the first omitted term is less than 0.5^15/16! of the value.
const TERMS: i32 = 15;

/// 1 - z/2 (1 - z/3 (1 - z/4 (...)))
fn series<A: Analytic>(z: A) -> A {
    let one = A::from(1.0);
    (2..=TERMS + 1).rev().fold(one, |sum, term| one - (z * sum).scaled(1.0 / f64::from(term)))
}

/// Derivative of the series: -1/2 + z/3 - z^2/8 + ...
fn slope_of_series<A: Analytic>(z: A) -> A {
    // (-1)^k k z^(k - 1)/(k + 1)!
    let mut factor = 1.0;
    let factors: Vec<f64> = (1..=TERMS)
        .map(|k| {
            factor /= -f64::from(k + 1);
            factor * f64::from(k)
        })
        .collect();
    factors.into_iter().rev().fold(A::from(0.0), |sum, factor| sum * z + A::from(factor))
}

impl Analytic for Complex64 {
    fn scaled(self, factor: f64) -> Complex64 {
        self * factor
    }

    fn exponential(self) -> Complex64 {
        portable::exp_complex(self)
    }

    fn mean_of_decay(self) -> Complex64 {
        if portable::magnitude(self) < SMALL {
            series(self)
        } else {
            (1.0 - portable::exp_complex(-self)) / self
        }
    }
}
