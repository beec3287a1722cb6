//! exp(A t) - I and the integrals that an exact step of a linear system needs.
//!
//! Squaring repeats rounding errors as often as the fastest mode fits into the step, so a slow pole
//! would have an error multiplied by its ratio to a fast one. The exponential is therefore formed
//! in twice the working precision: balanced, scaled by a power of two, summed as a Taylor series,
//! and squared back.

use nalgebra::DMatrix;
use pulp::{Arch, Simd, WithSimd};

use super::double_double::DoubleDouble;
use super::structure::balance;
use super::wide::Wide;

const TAYLOR_TERMS: i32 = 18;

/// exp(A t) - I, in which small entries (a slow mode, a short step) have full precision; infinite
/// or not a number where the result overflows.
pub(crate) fn exponential_less_identity(matrix: &DMatrix<f64>, time: f64) -> DMatrix<f64> {
    let order = matrix.nrows();
    let result = exponential(matrix, time);
    DMatrix::from_fn(order, order, |i, j| {
        let identity = DoubleDouble::from(if i == j { 1.0 } else { 0.0 });
        (result.entry(i, j) - identity).value()
    })
}

/// exp(A t) in twice the working precision.
pub(super) fn exponential(matrix: &DMatrix<f64>, time: f64) -> Wide {
    let mut balanced = matrix.clone();
    let scales = balance(&mut balanced);
    // halve until the norm is at most 1/16: 18 terms then leave 1e-37
    let norm = balanced.row_iter().map(|row| row.iter().map(|x| x.abs()).sum::<f64>()).fold(0.0, f64::max);
    let (_, exponent) = libm::frexp(norm * time.abs() * 16.0);
    let halvings = if norm == 0.0 { 0 } else { exponent.clamp(0, 1100) };
    let step = libm::ldexp(time, -halvings);
    let scaled = Wide::from_fn(matrix.nrows(), |i, j| DoubleDouble::product_of(balanced[(i, j)], step));
    let result = Arch::new().dispatch(Squaring { scaled, halvings });
    // the scales are powers of two
    Wide::from_fn(result.order(), |i, j| result.entry(i, j).scaled(scales[i]).scaled(1.0 / scales[j]))
}

/// exp(X 2^n) by the series of exp(X), squared n times, with the vector instructions of the
/// processor.
struct Squaring {
    scaled: Wide,
    halvings: i32,
}

impl WithSimd for Squaring {
    type Output = Wide;

    #[inline(always)]
    fn with_simd<D: Simd>(self, _: D) -> Wide {
        let mut result = Wide::identity(self.scaled.order());
        for term in (1..=TAYLOR_TERMS).rev() {
            // Horner: I + X/k (I + X/(k+1) (...))
            result = self.scaled.divided_by(f64::from(term)).times(&result).plus_identity();
        }
        for _ in 0..self.halvings {
            result = result.times(&result);
        }
        result
    }
}

/// Exact step of dx/dt = A x + B u over a time h, with u linear between its values at both ends.
pub(crate) struct ExactStep {
    /// exp(A h) - I: free change of the state over the step.
    pub(crate) increment: DMatrix<f64>,
    /// Effect of a constant input: integral of exp(A t) B over the step.
    pub(crate) constant: DMatrix<f64>,
    /// Effect of an input that rises from zero to one over the step.
    pub(crate) ramp: DMatrix<f64>,
}

impl ExactStep {
    /// The blocks of the exponential of [A B 0; 0 0 I/h; 0 0 0] h.
    pub(crate) fn new(a: &DMatrix<f64>, b: &DMatrix<f64>, time: f64) -> Self {
        let (order, inputs) = b.shape();
        if time == 0.0 {
            let none = DMatrix::zeros(order, inputs);
            return ExactStep { increment: DMatrix::zeros(order, order), constant: none.clone(), ramp: none };
        }
        let size = order + 2 * inputs;
        let mut augmented = DMatrix::zeros(size, size);
        augmented.view_mut((0, 0), (order, order)).copy_from(a);
        augmented.view_mut((0, order), (order, inputs)).copy_from(b);
        for input in 0..inputs {
            augmented[(order + input, order + inputs + input)] = 1.0 / time;
        }
        let result = exponential_less_identity(&augmented, time);
        let part = |column, count| result.view((0, column), (order, count)).into_owned();
        ExactStep {
            increment: part(0, order),
            constant: part(order, inputs),
            ramp: part(order + inputs, inputs),
        }
    }

    /// exp(A h).
    pub(crate) fn transition(&self) -> DMatrix<f64> {
        let (rows, columns) = self.increment.shape();
        &self.increment + DMatrix::<f64>::identity(rows, columns)
    }
}
