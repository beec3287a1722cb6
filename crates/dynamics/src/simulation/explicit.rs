//! Single step of an explicit Runge-Kutta method of order five.

use super::Lane;
use super::growth::AmplitudeLost;
use super::kernel::{Kernel, StepTrial};
use super::method::{Extension, StepInputs, relative_error};

/// Number of stages, including the first stage of the next step.
const STAGES: usize = 7;

/// Coefficients a_ij of stages 2 to 7, times h: contributions of earlier rates to the state.
const A: [&[f64]; STAGES - 1] = [
    &[1.0 / 5.0],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
    &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
    &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];

/// Fractions of the step at which the inputs of each stage are taken; the last two stages are both
/// at its end.
pub(super) const STAGE_TIMES: [f64; 6] = [0.0, 1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0];

/// Weights b_i less those of the embedded method of order 4.
const ERROR: [f64; STAGES] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0];

/// Weights d_i of the continuous extension.
const EXTENSION: [f64; STAGES] = [
    -12715105075.0 / 11282082432.0,
    0.0,
    87487479700.0 / 32700410799.0,
    -10690763975.0 / 1880347072.0,
    701980252875.0 / 199316789632.0,
    -1453857185.0 / 822651844.0,
    69997945.0 / 29380423.0,
];

/// On the imaginary axis, ln |R(i theta)| = -(1/600 - 1/720) theta^6 + ...
pub(super) const AMPLITUDE_LOST: AmplitudeLost = AmplitudeLost { factor: 1.0 / 3600.0, power: 6 };

/// Method with its memory.
///
/// ```text
/// k_i = f(y + h sum a_ij k_j, t + c_i h),        y(t + h) = y + h sum b_i k_i,        error: h sum (b_i - b*_i) k_i
/// ```
///
/// Order 5 with an embedded solution of order 4; continuous extension of order 4. Its step is
/// bounded by the fastest mode, h |lambda| < 3.3: an independent check of the implicit method for
/// systems that are not stiff. Source: Dormand and Prince (1980), Journal of Computational and
/// Applied Mathematics 6, 19; extension: Shampine (1986), Mathematics of Computation 46, 135.
#[derive(Clone, Debug)]
pub(super) struct DormandPrince<S> {
    /// Rates k_i, stage by stage.
    rates: Vec<S>,
    stage: Vec<S>,
    errors: Vec<S>,
    step: S,
    /// State at the end of the last step.
    pub(super) end: Vec<S>,
}

impl<S: Lane> DormandPrince<S> {
    /// Method for systems of this many states.
    pub(super) fn new(states: usize) -> Self {
        let zeros = vec![S::from(0.0); states];
        DormandPrince {
            rates: vec![S::from(0.0); STAGES * states],
            stage: zeros.clone(),
            errors: zeros.clone(),
            step: S::from(0.0),
            end: zeros,
        }
    }

    /// Evaluates the rates at the start of a step.
    pub(super) fn begin(&mut self, system: &dyn Kernel<S>, state: &[S], inputs: &StepInputs<S>) {
        system.rates(state, &inputs.stages[0], &mut self.rates[..state.len()]);
    }

    /// Attempts a step of length h from the point at which [`DormandPrince::begin`] was called;
    /// returns the error of each lane in units of the tolerance.
    pub(super) fn attempt(
        &mut self,
        system: &dyn Kernel<S>,
        trial: StepTrial<'_, S>,
        inputs: &StepInputs<S>,
    ) -> S {
        let StepTrial { state, step, scales, tolerance } = trial;
        let states = state.len();
        self.step = step;
        for (before, weights) in A.iter().enumerate() {
            let stage = before + 1;
            let (known, new) = self.rates.split_at_mut(stage * states);
            for (index, (place, &start)) in self.stage.iter_mut().zip(state).enumerate() {
                *place = start + step * combined(weights, known, index, states);
            }
            let at = stage.min(STAGE_TIMES.len() - 1);
            system.rates(&self.stage, &inputs.stages[at], &mut new[..states]);
        }
        self.end.copy_from_slice(&self.stage);
        for (index, error) in self.errors.iter_mut().enumerate() {
            *error = step * combined(&ERROR, &self.rates, index, states);
        }
        relative_error(&self.errors, state, &self.end, scales, tolerance)
    }

    /// One state over the last step.
    pub(super) fn extension(&self, index: usize, start: S) -> Extension<S> {
        let states = self.end.len();
        let end = self.end[index];
        let rise = end - start;
        let first = self.step * self.rates[index] - rise;
        let last = self.step * self.rates[(STAGES - 1) * states + index];
        let second = rise - last - first;
        let third = self.step * combined(&EXTENSION, &self.rates, index, states);
        Extension { start, end, coefficients: [first, second + third, -third] }
    }
}

/// Sum of w_i k_i for one state.
#[inline]
fn combined<S: Lane>(weights: &[f64], rates: &[S], index: usize, states: usize) -> S {
    let mut sum = rates[index].times(weights[0]);
    for (stage, &weight) in weights.iter().enumerate().skip(1) {
        sum = sum + rates[stage * states + index].times(weight);
    }
    sum
}
