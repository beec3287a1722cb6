//! Equilibria of a system.

use nalgebra::{DMatrix, DVector};

use super::System;
use super::derivatives::DIRECTIONS;
use crate::scalar::Dual;

/// Newton steps, and halvings of each.
const STEPS: usize = 100;
const HALVINGS: usize = 40;
/// Relative size of singular values that are taken as zero: a direction that the equations do not
/// determine, along which the guess is kept.
const SINGULAR: f64 = 1e-11;
/// Largest deviation of a state at an equilibrium, in scales.
const TOLERANCE: f64 = 1e-8;

/// Error for a missing equilibrium.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum EquilibriumError {
    /// A count that does not fit the system.
    #[error("{found} {what} where the system has {expected}")]
    Count {
        /// Name of the count.
        what: &'static str,
        /// Number found.
        found: usize,
        /// Number required.
        expected: usize,
    },
    /// A rate at the guess that is not a finite number.
    #[error("the equations have no value where the search begins")]
    NotFinite,
    /// No equilibrium near the guess.
    #[error("state {state} still moves at {rate} of its typical magnitude per second where all move least")]
    NotFound {
        /// Index of the state farthest from equilibrium.
        state: usize,
        /// Rate of this state over its scale, 1/s.
        rate: f64,
    },
}

/// Equilibrium state of a system under constant inputs, and the waves in transit in its delays, in
/// one vector: by damped Newton steps from a guess of both.
///
/// ```text
/// f(y, w, z) = 0,    z = g(y, w, z)        y states, w inputs, z the waves, which arrive as they were sent
/// ```
///
/// The Jacobian is exact. Values that these equations do not determine (a load in front of its
/// wall, the split between equal waves) keep their guess, and so do the states in `kept`: memories
/// such as the bristles of friction, which can rest anywhere.
///
/// # Errors
/// [`EquilibriumError`]; an equilibrium that violates its equations is not accepted.
///
/// # Example
/// A tank whose outflow sqrt(y) rises with its level: the equilibrium level for this inflow is 4.
/// ```
/// use phea_dynamics::scalar::Scalar;
/// use phea_dynamics::simulation::{System, equilibrium};
/// struct Tank;
/// impl System<f64> for Tank {
///     fn states(&self) -> usize {
///         1
///     }
///     fn inputs(&self) -> usize {
///         1
///     }
///     fn scales(&self) -> Vec<f64> {
///         vec![1.0]
///     }
///     fn rates<T: Scalar + From<f64>>(&self, y: &[T], w: &[T], rates: &mut [T]) {
///         rates[0] = w[0] - y[0].sqrt();
///     }
/// }
/// let level = equilibrium(&Tank, &[1.0], &[2.0], &[])?;
/// assert!((level[0] - 4.0).abs() < 1e-12);
/// # Ok::<(), phea_dynamics::simulation::EquilibriumError>(())
/// ```
pub fn equilibrium<E: System<f64>>(
    system: &E,
    guess: &[f64],
    inputs: &[f64],
    kept: &[usize],
) -> Result<Vec<f64>, EquilibriumError> {
    let (states, waves) = (system.states(), system.delays().len());
    let counts = [
        ("states and waves", guess.len(), states + waves),
        ("inputs", inputs.len() + waves, system.inputs()),
    ];
    if let Some((what, found, expected)) = counts.into_iter().find(|(_, found, expected)| found != expected) {
        return Err(EquilibriumError::Count { what, found, expected });
    }
    let search = EquilibriumSearch { system, states, guess, inputs, kept, scales: scales(system, guess) };
    let mut best = guess.to_vec();
    let (mut rest, mut jacobian) = search.surplus(&best);
    if rest.iter().chain(jacobian.iter()).any(|value| !value.is_finite()) {
        return Err(EquilibriumError::NotFinite);
    }
    for _ in 0..STEPS {
        // each equation relative to the effect of one scale of its most influential variable
        let weights: Vec<f64> =
            (0..rest.len()).map(|row| 1.0 / jacobian.row(row).amax().max(f64::MIN_POSITIVE)).collect();
        let weighted = |rest: &DVector<f64>| DVector::from_fn(rest.len(), |row, _| weights[row] * rest[row]);
        let before = weighted(&rest);
        if before.amax() <= f64::EPSILON {
            break;
        }
        let matrix =
            DMatrix::from_fn(rest.len(), rest.len(), |row, column| weights[row] * jacobian[(row, column)]);
        let Ok(step) = matrix.svd(true, true).solve(&before, SINGULAR) else { break };
        let mut fraction = 2.0;
        let better = (0..HALVINGS).find_map(|_| {
            fraction *= 0.5;
            let next: Vec<f64> = best
                .iter()
                .zip(step.iter().zip(&search.scales))
                .map(|(value, (step, scale))| value - fraction * step * scale)
                .collect();
            let (left, slopes) = search.surplus(&next);
            let finite = left.iter().chain(slopes.iter()).all(|value| value.is_finite());
            (finite && weighted(&left).norm() < before.norm()).then_some((next, left, slopes))
        });
        match better {
            Some((next, left, slopes)) => (best, rest, jacobian) = (next, left, slopes),
            None => break,
        }
    }
    search.checked(best, &rest, &jacobian)
}

struct EquilibriumSearch<'a, E> {
    system: &'a E,
    states: usize,
    guess: &'a [f64],
    inputs: &'a [f64],
    kept: &'a [usize],
    scales: Vec<f64>,
}

impl<E: System<f64>> EquilibriumSearch<'_, E> {
    /// The residual of each equation, and its derivatives with respect to all unknowns, each in its
    /// scale.
    fn surplus(&self, unknowns: &[f64]) -> (DVector<f64>, DMatrix<f64>) {
        let count = unknowns.len();
        let (mut rest, mut jacobian) = (DVector::zeros(count), DMatrix::zeros(count, count));
        let zero = Dual::<DIRECTIONS>::constant(0.0);
        let (mut rates, mut sent) = (vec![zero; self.states], vec![zero; count - self.states]);
        for first in (0..count).step_by(DIRECTIONS) {
            let seeded = |index: usize| {
                let mut gradient = [0.0; DIRECTIONS];
                if let Some(place) = index.checked_sub(first).and_then(|place| gradient.get_mut(place)) {
                    *place = self.scales[index];
                }
                Dual::new(unknowns[index], gradient)
            };
            let state: Vec<_> = (0..self.states).map(seeded).collect();
            let known = self.inputs.iter().map(|&input| Dual::constant(input));
            let inputs: Vec<_> = known.chain((self.states..count).map(seeded)).collect();
            self.system.rates(&state, &inputs, &mut rates);
            self.system.outgoing(&state, &inputs, &mut sent);
            let waves = sent.iter().zip(self.states..).map(|(&sent, index)| sent - seeded(index));
            for (row, value) in rates.iter().copied().chain(waves).enumerate() {
                let value = if self.kept.contains(&row) {
                    seeded(row) - Dual::constant(self.guess[row])
                } else {
                    value
                };
                rest[row] = value.value();
                for (column, slope) in (first..count).zip(value.gradient()) {
                    jacobian[(row, column)] = *slope;
                }
            }
        }
        (rest, jacobian)
    }

    /// Result of the search, if it is an equilibrium.
    fn checked(
        &self,
        found: Vec<f64>,
        rest: &DVector<f64>,
        jacobian: &DMatrix<f64>,
    ) -> Result<Vec<f64>, EquilibriumError> {
        let off = |row: usize| rest[row].abs() / jacobian.row(row).amax().max(f64::MIN_POSITIVE);
        if (0..found.len()).all(|row| off(row) <= TOLERANCE) {
            return Ok(found);
        }
        let rate = |state: usize| rest[state].abs() / self.scales[state];
        let farthest = |one: usize, other: usize| if off(other) > off(one) { other } else { one };
        let state = (0..self.states).reduce(farthest).unwrap_or_default();
        Err(EquilibriumError::NotFound { state, rate: rate(state) })
    }
}

/// Scales of the states, and of the waves by their guess.
fn scales<E: System<f64>>(system: &E, guess: &[f64]) -> Vec<f64> {
    let mut scales = system.scales();
    let waves = guess.iter().skip(scales.len()).map(|wave| wave.abs().max(1.0)).collect::<Vec<f64>>();
    scales.extend(waves);
    scales
}
