//! Steps of one fixed length with precomputed matrices: from sample to sample of a machine that is
//! nearly linear for a while.

use nalgebra::DMatrix;
use pulp::{Arch, Simd, WithSimd};

use super::kernel::StepTrial;
use super::rosenbrock::Rosenbrock;
use super::square::Square;
use super::{Lane, System};

/// Equations linearised at a state, and their solution over a step of one length, lane by lane.
///
/// ```text
/// y_1 = y_0 + h phi_1(h J) f(y_0),      r = f(y_1) - f(y_0) - J (y_1 - y_0)
/// y(t + h) = y_1 + 2 h phi_3(h J) r,    error: the last term
/// ```
///
/// Order 3 while J is the Jacobian at y_0, and exact for linear equations with constant inputs for
/// any step; an older J adds its change to r. Source: the method exprb32 of Hochbruck and Ostermann
/// (2010), Exponential integrators, Acta Numerica 19.
#[derive(Clone, Debug)]
pub(super) struct Propagator<S> {
    states: usize,
    /// Matrices J, h phi_1 and 2 h phi_3.
    jacobian: Square<S>,
    first: Square<S>,
    third: Square<S>,
    /// Damping of friction at which each lane's matrices were found.
    pub(super) friction: Vec<f64>,
    /// Step of each lane in s; NaN for a lane without a step.
    step_s: Vec<f64>,
    /// State, rates at both ends, remainder and difference.
    pub(super) end: Vec<S>,
    pub(super) rates: [Vec<S>; 2],
    remainder: Vec<[S; 4]>,
    difference: Vec<[S; 4]>,
    /// Steps since each lane's matrices were found.
    age: Vec<u32>,
}

/// Least number of steps after which a lane's matrices are found again: finding them costs as much
/// as several ordinary steps.
const LEAST_AGE: u32 = 8;

/// Relative difference up to which steps count as equal.
const SAME: f64 = 1e-9;

impl<S: Lane> Propagator<S> {
    pub(super) fn new(states: usize) -> Propagator<S> {
        let (zero, matrix, groups) = (S::from(0.0), Square::new(states), states.div_ceil(4));
        Propagator {
            states,
            jacobian: matrix.clone(),
            first: matrix.clone(),
            third: matrix,
            friction: vec![0.0; S::COUNT],
            step_s: vec![f64::NAN; S::COUNT],
            end: vec![zero; states],
            rates: [vec![zero; states], vec![zero; states]],
            remainder: vec![[zero; 4]; groups],
            difference: vec![[zero; 4]; groups],
            age: vec![LEAST_AGE; S::COUNT],
        }
    }

    /// True if a lane has matrices for this step.
    pub(super) fn knows(&self, lane: usize, step_s: f64) -> bool {
        (self.step_s[lane] - step_s).abs() <= SAME * step_s
    }

    /// Removes a lane's matrices for another machine.
    pub(super) fn forget(&mut self, lane: usize) {
        self.step_s[lane] = f64::NAN;
        self.age[lane] = LEAST_AGE;
    }

    /// True if a lane's matrices may be found again.
    pub(super) fn may_learn(&mut self, lane: usize) -> bool {
        self.age[lane] = self.age[lane].saturating_add(1);
        self.age[lane] > LEAST_AGE
    }

    /// Finds a lane's matrices for a step, from the Jacobian at its current state.
    pub(super) fn learn(&mut self, lane: usize, step_s: f64, method: &Rosenbrock<S>, scales: &[S]) {
        let states = self.states;
        let scales: Vec<f64> = scales.iter().map(|scale| scale.lane(lane)).collect();
        let mut scaled = Square::new(states);
        self.jacobian.clear(lane);
        for (row, column, value) in method.jacobian_entries() {
            let value = value.lane(lane);
            self.jacobian.entry(row, column).set_lane(lane, value);
            *scaled.entry(row, column) = step_s * value * scales[column] / scales[row];
        }
        let [mut first, mut third] = Arch::new().dispatch(Functions { z: scaled });
        let finite = first.is_finite() && third.is_finite();
        for row in 0..states {
            for column in 0..states {
                let unit = step_s * scales[row] / scales[column];
                self.first.entry(row, column).set_lane(lane, unit * *first.entry(row, column));
                self.third.entry(row, column).set_lane(lane, 2.0 * unit * *third.entry(row, column));
            }
        }
        self.step_s[lane] = if finite { step_s } else { f64::NAN };
        self.age[lane] = 0;
    }

    /// Takes the step from a state with constant inputs; returns the error of each lane in units of
    /// the tolerance.
    #[inline(always)]
    pub(super) fn step<E: System<S>>(&mut self, system: &E, trial: StepTrial<'_, S>, inputs: &[S]) -> S {
        let StepTrial { state, scales, tolerance, .. } = trial;
        let [before, after] = &mut self.rates;
        system.rates(state, inputs, before);
        self.first.times(before, &mut self.difference);
        let difference = self.difference.as_flattened();
        for ((end, &start), &difference) in self.end.iter_mut().zip(state).zip(difference) {
            *end = start + difference;
        }
        system.rates(&self.end, inputs, after);
        self.jacobian.times(difference, &mut self.remainder);
        let remainder = self.remainder.as_flattened_mut();
        for ((remainder, &before), &after) in remainder.iter_mut().zip(&*before).zip(&*after) {
            *remainder = (after - before) - *remainder;
        }
        self.third.times(remainder, &mut self.difference);
        let mut sum = S::from(0.0);
        let ends = self.end.iter_mut().zip(state).zip(self.difference.as_flattened()).zip(scales);
        for (((end, &start), &error), &scale) in ends {
            let magnitude = start.abs().maximum(end.abs());
            sum = sum + (error / (scale + magnitude)).squared();
            *end = *end + error;
        }
        sum.times(1.0 / self.states.max(1) as f64).sqrt().times(1.0 / tolerance)
    }
}

/// Function phi_1 of a matrix.
pub(super) fn first_function(z: &DMatrix<f64>) -> DMatrix<f64> {
    let order = z.nrows();
    let mut square = Square::new(order);
    for column in 0..order {
        for row in 0..order {
            *square.entry(row, column) = z[(row, column)];
        }
    }
    let [mut first, _] = Arch::new().dispatch(Functions { z: square });
    DMatrix::from_fn(order, order, |row, column| *first.entry(row, column))
}

/// [`first_and_third`] with the vector instructions of the processor.
struct Functions {
    z: Square<f64>,
}

impl WithSimd for Functions {
    type Output = [Square<f64>; 2];

    #[inline(always)]
    fn with_simd<V: Simd>(self, _: V) -> [Square<f64>; 2] {
        first_and_third(self.z)
    }
}

/// Functions phi_1(Z) and phi_3(Z) by the series of Z over a power of two, and doubling.
///
/// ```text
/// phi_k(Z) = sum over n of Z^n/(n + k)!,        phi_{k-1}(Z) = Z phi_k(Z) + 1/(k - 1)!
/// phi_1(2 Z) = (e^Z + 1) phi_1/2,   phi_2(2 Z) = (phi_1^2 + 2 phi_2)/4,   phi_3(2 Z) = (phi_1 phi_2 + phi_2 + 2 phi_3)/8
/// ```
#[inline(always)]
fn first_and_third(mut z: Square<f64>) -> [Square<f64>; 2] {
    let norm = z.largest_row_sum();
    let (mut halvings, mut part) = (0, 1.0);
    while norm * part > 0.5 && halvings < 60 {
        (halvings, part) = (halvings + 1, 0.5 * part);
    }
    z.entries_mut().for_each(|x| *x *= part);
    // Horner's scheme for the sum of Z^n/(n + 3)!, omitted terms below 0.5^12/15!
    let mut phi_3 = Square::new(z.order());
    phi_3.add_identity(1.0);
    for order in (4..=14).rev() {
        phi_3 = z.after(&phi_3);
        phi_3.entries_mut().for_each(|x| *x /= f64::from(order));
        phi_3.add_identity(1.0);
    }
    phi_3.entries_mut().for_each(|x| *x /= 6.0);
    let mut phi_2 = z.after(&phi_3);
    phi_2.add_identity(0.5);
    let mut phi_1 = z.after(&phi_2);
    phi_1.add_identity(1.0);
    let mut exponential = z.after(&phi_1);
    exponential.add_identity(1.0);
    for _ in 0..halvings {
        let (mixed, square) = (phi_1.after(&phi_2), phi_1.after(&phi_1));
        let doubled = exponential.after(&phi_1);
        for ((third, second), mixed) in phi_3.entries_mut().zip(phi_2.entries()).zip(mixed.entries()) {
            *third = (mixed + second + 2.0 * *third) / 8.0;
        }
        for (second, square) in phi_2.entries_mut().zip(square.entries()) {
            *second = (square + 2.0 * *second) / 4.0;
        }
        for (first, doubled) in phi_1.entries_mut().zip(doubled.entries()) {
            *first = (doubled + *first) / 2.0;
        }
        exponential = exponential.after(&exponential);
    }
    [phi_1, phi_3]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::portable;

    /// Functions of a matrix of two states, given row by row.
    fn functions(z: [f64; 4]) -> [Square<f64>; 2] {
        let mut matrix = Square::new(2);
        for (place, value) in z.into_iter().enumerate() {
            *matrix.entry(place / 2, place % 2) = value;
        }
        first_and_third(matrix)
    }

    /// One eigenvalue at a time: (e^z - 1)/z and (e^z - 1 - z - z^2/2)/z^3, and a nilpotent matrix,
    /// whose series ends.
    #[test]
    fn the_functions_agree_with_their_closed_forms() {
        for z in [-40.0, -3.0, -0.7, 0.9, 5.0] {
            let [mut first, mut third] = functions([z, 0.0, 0.0, -2.0]);
            let expected = portable::expm1(z) / z;
            assert!((*first.entry(0, 0) / expected - 1.0).abs() < 1e-12);
            let expected = (portable::expm1(z) - z - 0.5 * z * z) / (z * z * z);
            assert!((*third.entry(0, 0) / expected - 1.0).abs() < 1e-12);
        }
        let [mut first, mut third] = functions([0.0, 6.0, 0.0, 0.0]);
        assert!((*first.entry(0, 1) - 3.0).abs() < 1e-14 && (*third.entry(0, 1) - 0.25).abs() < 1e-15);
    }
}
