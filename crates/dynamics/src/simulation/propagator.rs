//! Steps of one and the same length, taken with matrices found once: how a machine that is nearly linear for a while gets
//! from sample to sample.

use super::rosenbrock::Rosenbrock;
use super::square::Square;
use super::{Lane, System};

/// The equations around a state, and what they make of a step of one length, lane by lane.
///
/// ```text
/// y_1 = y_0 + h phi_1(h J) f(y_0),      r = f(y_1) - f(y_0) - J (y_1 - y_0)
/// y(t + h) = y_1 + 2 h phi_3(h J) r,    error: the last term
/// ```
///
/// Order 3 while J is the Jacobian at y_0, and exact for linear equations with inputs that stand still whatever the step;
/// a J found earlier adds to r what it has changed by. Source: the method exprb32 of Hochbruck and Ostermann (2010),
/// Exponential integrators, Acta Numerica 19.
#[derive(Clone, Debug)]
pub(super) struct Propagator<S> {
    states: usize,
    /// J, h phi_1 and 2 h phi_3.
    jacobian: Square<S>,
    first: Square<S>,
    third: Square<S>,
    /// Damping of friction where each lane's matrices were found.
    pub(super) friction: Vec<f64>,
    /// The step of each lane in s; not a number where there is none.
    step_s: Vec<f64>,
    /// State, rates at both ends, remainder, difference.
    pub(super) end: Vec<S>,
    pub(super) rates: [Vec<S>; 2],
    remainder: Vec<[S; 4]>,
    difference: Vec<[S; 4]>,
    /// How many steps ago each lane's matrices were found.
    age: Vec<u32>,
}

/// A lane's matrices are found again after this many steps at the earliest: it costs as much as several steps without.
const LEAST_AGE: u32 = 8;

/// Steps of this relative difference are one.
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

    /// Whether a lane has matrices for this step.
    pub(super) fn knows(&self, lane: usize, step_s: f64) -> bool {
        (self.step_s[lane] - step_s).abs() <= SAME * step_s
    }

    /// Forgets a lane's matrices: another machine is in it.
    pub(super) fn forget(&mut self, lane: usize) {
        self.step_s[lane] = f64::NAN;
        self.age[lane] = LEAST_AGE;
    }

    /// Whether a lane's matrices may be found again.
    pub(super) fn may_learn(&mut self, lane: usize) -> bool {
        self.age[lane] = self.age[lane].saturating_add(1);
        self.age[lane] > LEAST_AGE
    }

    /// Finds a lane's matrices for a step, from the Jacobian at its present state.
    pub(super) fn learn(&mut self, lane: usize, step_s: f64, method: &Rosenbrock<S>, scales: &[S]) {
        let states = self.states;
        let scales: Vec<f64> = scales.iter().map(|scale| scale.lane(lane)).collect();
        let mut scaled = vec![0.0; states * states];
        self.jacobian.clear(lane);
        for (row, column, value) in method.jacobian_entries() {
            let (place, value) = (row * states + column, value.lane(lane));
            self.jacobian.entry(row, column).set_lane(lane, value);
            scaled[place] = step_s * value * scales[column] / scales[row];
        }
        let [first, third] = first_and_third(&scaled, states);
        for row in 0..states {
            for column in 0..states {
                let (place, unit) = (row * states + column, step_s * scales[row] / scales[column]);
                self.first.entry(row, column).set_lane(lane, unit * first[place]);
                self.third.entry(row, column).set_lane(lane, 2.0 * unit * third[place]);
            }
        }
        self.step_s[lane] =
            if first.iter().chain(&third).all(|value| value.is_finite()) { step_s } else { f64::NAN };
        self.age[lane] = 0;
    }

    /// The step from a state with inputs that stand still; the error of each lane in units of the tolerance.
    pub(super) fn attempt<E: System<S>>(
        &mut self,
        system: &E,
        state: &[S],
        inputs: &[S],
        scales: &[S],
        tolerance: f64,
    ) -> S {
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

/// phi_1(Z) and phi_3(Z) by the series of Z over a power of two, and doubling.
///
/// ```text
/// phi_k(Z) = sum over n of Z^n/(n + k)!,        phi_{k-1}(Z) = Z phi_k(Z) + 1/(k - 1)!
/// phi_1(2 Z) = (e^Z + 1) phi_1/2,   phi_2(2 Z) = (phi_1^2 + 2 phi_2)/4,   phi_3(2 Z) = (phi_1 phi_2 + phi_2 + 2 phi_3)/8
/// ```
fn first_and_third(z: &[f64], states: usize) -> [Vec<f64>; 2] {
    let norm = z.chunks_exact(states.max(1)).map(|row| row.iter().map(|x| x.abs()).sum()).fold(0.0, f64::max);
    let (mut halvings, mut part) = (0, 1.0);
    while norm * part > 0.5 && halvings < 60 {
        (halvings, part) = (halvings + 1, 0.5 * part);
    }
    let z: Vec<f64> = z.iter().map(|x| x * part).collect();
    // Horner's scheme for the sum of Z^n/(n + 3)!, the terms left out below 0.5^12/15!.
    let mut phi_3 = identity(states, 1.0);
    for order in (4..=14).rev() {
        phi_3 = product(&z, &phi_3, states);
        phi_3.iter_mut().for_each(|x| *x /= f64::from(order));
        add_identity(&mut phi_3, states, 1.0);
    }
    phi_3.iter_mut().for_each(|x| *x /= 6.0);
    let mut phi_2 = product(&z, &phi_3, states);
    add_identity(&mut phi_2, states, 0.5);
    let mut phi_1 = product(&z, &phi_2, states);
    add_identity(&mut phi_1, states, 1.0);
    let mut exponential = product(&z, &phi_1, states);
    add_identity(&mut exponential, states, 1.0);
    for _ in 0..halvings {
        let mixed = product(&phi_1, &phi_2, states);
        let square = product(&phi_1, &phi_1, states);
        let doubled = product(&exponential, &phi_1, states);
        for index in 0..phi_3.len() {
            phi_3[index] = (mixed[index] + phi_2[index] + 2.0 * phi_3[index]) / 8.0;
            phi_2[index] = (square[index] + 2.0 * phi_2[index]) / 4.0;
            phi_1[index] = (doubled[index] + phi_1[index]) / 2.0;
        }
        exponential = product(&exponential, &exponential, states);
    }
    [phi_1, phi_3]
}

fn identity(states: usize, value: f64) -> Vec<f64> {
    let mut matrix = vec![0.0; states * states];
    add_identity(&mut matrix, states, value);
    matrix
}

fn add_identity(matrix: &mut [f64], states: usize, value: f64) {
    matrix.iter_mut().step_by(states + 1).for_each(|entry| *entry += value);
}

fn product(left: &[f64], right: &[f64], states: usize) -> Vec<f64> {
    let mut result = vec![0.0; states * states];
    for (row, left) in result.chunks_exact_mut(states).zip(left.chunks_exact(states)) {
        for (&factor, right) in left.iter().zip(right.chunks_exact(states)) {
            for (value, &entry) in row.iter_mut().zip(right) {
                *value += factor * entry;
            }
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::portable;

    /// One eigenvalue at a time: (e^z - 1)/z and (e^z - 1 - z - z^2/2)/z^3, and a nilpotent matrix, whose series ends.
    #[test]
    fn the_functions_agree_with_their_closed_forms() {
        for z in [-40.0, -3.0, -0.7, 0.9, 5.0] {
            let [first, third] = first_and_third(&[z, 0.0, 0.0, -2.0], 2);
            let expected = portable::expm1(z) / z;
            assert!((first[0] / expected - 1.0).abs() < 1e-12);
            let expected = (portable::expm1(z) - z - 0.5 * z * z) / (z * z * z);
            assert!((third[0] / expected - 1.0).abs() < 1e-12);
        }
        let [first, third] = first_and_third(&[0.0, 6.0, 0.0, 0.0], 2);
        assert!((first[1] - 3.0).abs() < 1e-14 && (third[1] - 0.25).abs() < 1e-15);
    }
}
