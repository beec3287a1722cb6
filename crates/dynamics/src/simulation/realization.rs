//! State-space realisation of a compensator or a sensor.

use nalgebra::{DMatrix, DVector};

use crate::linear::{LinearError, LinearOperation, StateSpace, TimeDomain, TransferFunction};
use crate::scalar::Scalar;

/// Relative size of singular values that are taken as zero: an equation without information.
const SINGULAR: f64 = 1e-12;

/// Compensator as states, its zero entries left out.
///
/// ```text
/// dx/dt = A x + B e,        y = C x + D e
/// ```
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Realization {
    pub(super) states: usize,
    /// Entries (column, value) of each row of A.
    dynamics: Vec<Vec<(usize, f64)>>,
    /// Column B.
    drive: Vec<f64>,
    /// Entries (column, value) of C.
    taps: Vec<(usize, f64)>,
    pub(super) feedthrough: f64,
}

impl Realization {
    pub(super) fn new(function: &TransferFunction) -> Result<Realization, LinearError> {
        if function.domain() != TimeDomain::Continuous {
            return Err(LinearError::WrongDomain {
                operation: LinearOperation::BetweenSamples,
                needed: "continuous",
            });
        }
        let system = StateSpace::from_transfer_function(function)?;
        let states = system.order();
        let entries = |matrix: &DMatrix<f64>, row: usize| -> Vec<(usize, f64)> {
            let all = matrix.row(row).iter().copied().enumerate().collect::<Vec<_>>();
            all.into_iter().filter(|entry| entry.1 != 0.0).collect()
        };
        Ok(Realization {
            states,
            dynamics: (0..states).map(|state| entries(system.a(), state)).collect(),
            drive: (0..states).map(|row| system.b()[(row, 0)]).collect(),
            taps: entries(system.c(), 0),
            feedthrough: system.d()[(0, 0)],
        })
    }

    /// Magnitudes of the states that produce an output of this magnitude, directly or through the
    /// states that they drive.
    pub(super) fn scales<S: Scalar>(&self, output: S) -> Vec<S> {
        let mut parts = vec![f64::INFINITY; self.states];
        for &(column, value) in &self.taps {
            parts[column] = 1.0 / value.abs();
        }
        let rate = |state: usize| {
            let own = self.dynamics[state].iter().find(|entry| entry.0 == state);
            own.map_or(1.0, |entry| entry.1.abs())
        };
        // a chain of sections lists the last one first: the states that a state drives precede it
        for state in 0..self.states {
            for row in (0..state).filter(|&row| parts[row].is_finite()).collect::<Vec<_>>() {
                for (_, value) in self.dynamics[row].iter().filter(|entry| entry.0 == state) {
                    parts[state] = parts[state].min(parts[row] * rate(row) / value.abs());
                }
            }
        }
        parts.iter().map(|&part| output.times(if part.is_finite() { part } else { 1.0 })).collect()
    }

    /// Product C x.
    #[inline(always)]
    fn tapped<T: Scalar>(&self, state: &[T]) -> T {
        let products = self.taps.iter().map(|&(column, value)| state[column].times(value));
        products.fold(T::from(0.0), |sum, product| sum + product)
    }

    #[inline(always)]
    pub(super) fn output<T: Scalar>(&self, state: &[T], input: T) -> T {
        self.tapped(state) + input.times(self.feedthrough)
    }

    #[inline(always)]
    pub(super) fn rates<T: Scalar>(&self, state: &[T], input: T, rates: &mut [T]) {
        for ((rate, terms), &drive) in rates.iter_mut().zip(&self.dynamics).zip(&self.drive) {
            let mut sum = if drive == 0.0 { T::from(0.0) } else { input.times(drive) };
            for &(column, value) in terms {
                sum = sum + state[column].times(value);
            }
            *rate = sum;
        }
    }

    /// States that are constant under an input and, if it is stated, give an output; the nearest to
    /// that if none do.
    ///
    /// ```text
    /// A x = -B e,    C x = y - D e        each equation over the largest number of its row, least squares
    /// ```
    pub(super) fn at_rest(&self, input: f64, output: Option<f64>) -> Vec<f64> {
        if self.states == 0 {
            return Vec::new();
        }
        let rows = self.states + usize::from(output.is_some());
        let (mut left, mut right) = (DMatrix::zeros(rows, self.states), DVector::zeros(rows));
        for (row, (terms, drive)) in self.dynamics.iter().zip(&self.drive).enumerate() {
            for &(column, value) in terms {
                left[(row, column)] = value;
            }
            right[row] = -drive * input;
        }
        if let Some(output) = output {
            for &(column, value) in &self.taps {
                left[(self.states, column)] = value;
            }
            right[self.states] = output - self.feedthrough * input;
        }
        for row in 0..rows {
            let size: f64 = left.row(row).amax();
            if size > 0.0 {
                left.row_mut(row).scale_mut(1.0 / size);
                right[row] /= size;
            }
        }
        let solution = left.svd(true, true).solve(&right, SINGULAR);
        solution.map_or_else(|_| vec![0.0; self.states], |states| states.iter().copied().collect())
    }
}
