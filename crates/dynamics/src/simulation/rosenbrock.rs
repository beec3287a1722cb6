//! One step of an L-stable Rosenbrock method of order five.

use super::pattern::Pattern;
use super::step_matrix::StepMatrix;
use super::{Lane, System};
use crate::scalar::{Dependence, Dual};

/// Stages of the method.
const STAGES: usize = 8;

/// Derivatives found in one evaluation.
pub(super) const DIRECTIONS: usize = 6;

/// gamma, on the diagonal of every stage.
const GAMMA: f64 = 0.21193756319429014;

/// a_ij: what the stages before add to the state of stage i; those of the last two stages are one.
const A: [[f64; 5]; 6] = [
    [0.0; 5],
    [3.0, 0.0, 0.0, 0.0, 0.0],
    [2.849394379747939, 0.45842242204463923, 0.0, 0.0, 0.0],
    [-6.954028509809101, 2.489845061869568, -10.358996098473584, 0.0, 0.0],
    [2.8029986275628964, 0.5072464736228206, -0.3988312541770524, -0.04721187230404641, 0.0],
    [-7.502846399306121, 2.561846144803919, -11.627539656261098, -0.18268767659942256, 0.030198172008377946],
];

/// c_ij: what the stages before add to the right-hand side of stage i, over h.
const C: [[f64; 7]; STAGES] = [
    [0.0; 7],
    [-14.155112264123755, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [-17.97296035885952, -2.859693295451294, 0.0, 0.0, 0.0, 0.0, 0.0],
    [147.12150275711716, -1.41221402718213, 71.68940251302358, 0.0, 0.0, 0.0, 0.0],
    [165.43517024871676, -0.4592823456491126, 42.90938336958603, -5.961986721573306, 0.0, 0.0, 0.0],
    [
        24.854864614690072,
        -3.0009227002832186,
        47.4931110020768,
        5.5814197821558125,
        -0.6610691825249471,
        0.0,
        0.0,
    ],
    [
        30.91273214028599,
        -3.1208243349937974,
        77.79954646070892,
        34.28646028294783,
        -19.097331116725623,
        -28.087943162872662,
        0.0,
    ],
    [
        37.80277123390563,
        -3.2571969029072276,
        112.26918849496327,
        66.9347231244047,
        -40.06618937091002,
        -54.66780262877968,
        -9.48861652309627,
    ],
];

/// Where in the step the inputs of each stage are taken.
pub(super) const STAGE_TIMES: [f64; 6] =
    [0.0, 0.6358126895828704, 0.4095798393397535, 0.9769306725060716, 0.4288403609558664, 1.0];

/// d_i: weight of the slope in time.
const SLOPE_WEIGHTS: [f64; 5] =
    [0.21193756319429014, -0.42387512638858027, -0.3384627126235924, 1.8046452872882734, 2.325825639765069];

/// h_ij of the continuous extension.
const EXTENSION: [[f64; STAGES]; 3] = [
    [
        25.948786856663858,
        -2.5579724845846235,
        10.433815404888879,
        -2.3679251022685204,
        0.524948541321073,
        1.1241088310450404,
        0.4272876194431874,
        -0.17202221070155493,
    ],
    [
        -9.91568850695171,
        -0.9689944594115154,
        3.0438037242978453,
        -24.495224566215796,
        20.176138334709044,
        15.98066361424651,
        -6.789040303419874,
        -6.710236069923372,
    ],
    [
        11.419903575922262,
        2.8879645146136994,
        72.92137995996029,
        80.12511834622643,
        -52.072871366152654,
        -59.78993625266729,
        -0.15582684282751913,
        4.883087185713722,
    ],
];

/// Inputs of one step: at the time of every stage, and their slopes in time at its start.
#[derive(Clone, Debug)]
pub(super) struct StepInputs<S> {
    /// At the times of [`STAGE_TIMES`].
    pub(super) stages: [Vec<S>; 6],
    /// Per second, at the start.
    pub(super) slopes: Vec<S>,
    /// Whether any slope differs from zero.
    pub(super) moving: bool,
}

/// The method with its memory, for a system of one pattern.
///
/// ```text
/// (1/(h gamma) - J) u_i = f(y + sum a_ij u_j, t + alpha_i h) + sum c_ij u_j/h + h d_i df/dt
/// y(t + h) = y + sum b_i u_i,        error: u_8
/// ```
///
/// Order 5 with an embedded solution of order 4, both L-stable, stiffly accurate; continuous extension of order 4.
/// Source: Rodas5P, Steinebach (2023), BIT Numerical Mathematics 63, 27.
#[derive(Clone, Debug)]
pub(super) struct Rosenbrock<S> {
    pattern: Pattern,
    matrix: StepMatrix<S>,
    scales: Vec<f64>,
    increments: Vec<[S; STAGES]>,
    stage: Vec<S>,
    rates: Vec<S>,
    right: Vec<S>,
    slopes: Vec<S>,
    seeded: Vec<Dual<DIRECTIONS, S>>,
    seeded_inputs: Vec<Dual<DIRECTIONS, S>>,
    seeded_rates: Vec<Dual<DIRECTIONS, S>>,
    /// J, row by row as in the pattern.
    jacobian: Vec<Vec<S>>,
    /// State at the end of the last step.
    pub(super) end: Vec<S>,
}

impl<S: Lane> Rosenbrock<S>
where
    Dependence: From<S>,
    Dual<DIRECTIONS, S>: From<f64> + From<S>,
{
    /// For this system; `None` when it is too large to find its pattern.
    pub(super) fn new<E: System<S>>(system: &E) -> Option<Self> {
        let pattern = Pattern::of(system)?;
        let (states, inputs) = (system.states(), system.inputs());
        let zero = S::from(0.0);
        let seeded = vec![Dual::constant(zero); states];
        Some(Rosenbrock {
            matrix: StepMatrix::new(&pattern.rows),
            scales: system.scales(),
            increments: vec![[zero; STAGES]; states],
            stage: vec![zero; states],
            rates: vec![zero; states],
            right: vec![zero; states],
            slopes: vec![zero; states],
            seeded_inputs: vec![Dual::constant(zero); inputs],
            seeded_rates: seeded.clone(),
            seeded,
            jacobian: pattern.rows.iter().map(|row| vec![zero; row.len()]).collect(),
            end: vec![zero; states],
            pattern,
        })
    }

    /// Rates, Jacobian and slopes in time at the start of a step.
    pub(super) fn linearize<E: System<S>>(&mut self, system: &E, state: &[S], inputs: &StepInputs<S>) {
        let zero = S::from(0.0);
        self.slopes.fill(zero);
        // The slope in time is one more direction.
        let directions = self.pattern.colour_count + usize::from(inputs.moving);
        for first in (0..directions.max(1)).step_by(DIRECTIONS) {
            for ((seeded, &value), &colour) in self.seeded.iter_mut().zip(state).zip(&self.pattern.colours) {
                *seeded = match colour.checked_sub(first) {
                    Some(direction) => Dual::variable(value, direction),
                    None => Dual::constant(value),
                };
            }
            let in_time = self.pattern.colour_count.checked_sub(first).filter(|_| inputs.moving);
            let at_start = self.seeded_inputs.iter_mut().zip(&inputs.stages[0]).zip(&inputs.slopes);
            for ((seeded, &value), &slope) in at_start {
                let mut gradient = [zero; DIRECTIONS];
                if let Some(place) = in_time.and_then(|direction| gradient.get_mut(direction)) {
                    *place = slope;
                }
                *seeded = Dual::new(value, gradient);
            }
            system.rates(&self.seeded, &self.seeded_inputs, &mut self.seeded_rates);
            for (row, rate) in self.seeded_rates.iter().enumerate() {
                for (entry, &column) in self.jacobian[row].iter_mut().zip(&self.pattern.rows[row]) {
                    let direction = self.pattern.colours[column].checked_sub(first);
                    if let Some(&value) = direction.and_then(|direction| rate.gradient().get(direction)) {
                        *entry = value;
                    }
                }
                if let Some(&slope) = in_time.and_then(|direction| rate.gradient().get(direction)) {
                    self.slopes[row] = slope;
                }
                self.rates[row] = rate.value();
            }
        }
    }

    /// One step of length h from here, [`Rosenbrock::linearize`] having been called here; the error of each lane in
    /// units of the tolerance. Above one, or not a number, the step is to be tried again with a shorter one.
    pub(super) fn attempt<E: System<S>>(
        &mut self,
        system: &E,
        state: &[S],
        step: S,
        inputs: &StepInputs<S>,
        tolerance: f64,
    ) -> S {
        let per_step = S::from(1.0) / step;
        self.matrix.reset(per_step * S::from(1.0 / GAMMA));
        for (row, entries) in self.jacobian.iter().enumerate() {
            for (place, &entry) in entries.iter().enumerate() {
                self.matrix.subtract(row, place, entry);
            }
        }
        let kept = self.matrix.factor();
        for stage in 0..STAGES {
            self.begin_stage(stage, state);
            if stage > 0 {
                let at = stage.min(STAGE_TIMES.len() - 1);
                system.rates(&self.stage, &inputs.stages[at], &mut self.right);
            } else {
                self.right.copy_from_slice(&self.rates);
            }
            self.finish_stage(stage, step, per_step, inputs.moving);
        }
        let last = self.increments.iter().map(|increments| increments[STAGES - 1]);
        for ((end, &stage), increment) in self.end.iter_mut().zip(&self.stage).zip(last) {
            *end = stage + increment;
        }
        let error = self.error(state, tolerance);
        S::select(S::from(0.0).less_than(kept), error, S::from(f64::INFINITY))
    }

    fn begin_stage(&mut self, stage: usize, state: &[S]) {
        match A.get(stage) {
            Some(weights) => {
                let of_state = self.stage.iter_mut().zip(state).zip(&self.increments);
                for ((value, &start), increments) in of_state {
                    let mut sum = start;
                    for (&weight, &increment) in weights.iter().zip(increments).take(stage) {
                        sum = sum + S::from(weight) * increment;
                    }
                    *value = sum;
                }
            }
            None => {
                for (value, increments) in self.stage.iter_mut().zip(&self.increments) {
                    *value = *value + increments[stage - 1];
                }
            }
        }
    }

    fn finish_stage(&mut self, stage: usize, step: S, per_step: S, moving: bool) {
        let weights = &C[stage];
        for (right, increments) in self.right.iter_mut().zip(&self.increments) {
            let mut sum = S::from(0.0);
            for (&weight, &increment) in weights.iter().zip(increments).take(stage) {
                sum = sum + S::from(weight) * increment;
            }
            *right = *right + sum * per_step;
        }
        if let Some(&weight) = SLOPE_WEIGHTS.get(stage).filter(|_| moving) {
            let weighted = S::from(weight) * step;
            for (right, &slope) in self.right.iter_mut().zip(&self.slopes) {
                *right = *right + weighted * slope;
            }
        }
        self.matrix.solve(&mut self.right);
        for (increments, &solution) in self.increments.iter_mut().zip(&self.right) {
            increments[stage] = solution;
        }
    }

    /// Root mean square of the error over tolerance (scale + |y|).
    fn error(&self, state: &[S], tolerance: f64) -> S {
        let mut sum = S::from(0.0);
        for (index, increments) in self.increments.iter().enumerate() {
            let magnitude = state[index].abs().maximum(self.end[index].abs());
            let allowed = S::from(tolerance) * (S::from(self.scales[index]) + magnitude);
            sum = sum + (increments[STAGES - 1] / allowed).squared();
        }
        (sum / S::from(self.increments.len().max(1) as f64)).sqrt()
    }

    /// Root mean square of rates over (scale + |y|) in one lane, per second.
    pub(super) fn magnitude(&self, rates: &[S], state: &[S], lane: usize) -> f64 {
        let parts = rates.iter().zip(state).zip(&self.scales).map(|((rate, state), scale)| {
            let part = rate.lane(lane) / (scale + state.lane(lane).abs());
            part * part
        });
        (parts.sum::<f64>() / rates.len().max(1) as f64).sqrt()
    }

    /// Coefficients of one state over the last step:
    ///
    /// ```text
    /// y(theta) = (1 - theta) y_0 + theta (y_1 + (1 - theta) (k_1 + theta (k_2 + theta k_3)))
    /// ```
    pub(super) fn extension(&self, index: usize, start: S) -> Extension<S> {
        let increments = &self.increments[index];
        let combine = |weights: &[f64; STAGES]| {
            let products = weights.iter().zip(increments);
            products.fold(S::from(0.0), |sum, (&weight, &increment)| sum + S::from(weight) * increment)
        };
        let [first, second, third] = [0, 1, 2].map(|row| combine(&EXTENSION[row]));
        Extension { start, end: self.end[index], coefficients: [first, second, third] }
    }
}

/// A state over one step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extension<S> {
    start: S,
    end: S,
    coefficients: [S; 3],
}

impl<S: Lane> Extension<S> {
    /// The same in one lane.
    pub(super) fn lane(&self, index: usize) -> Extension<f64> {
        let coefficients = self.coefficients.map(|coefficient| coefficient.lane(index));
        Extension { start: self.start.lane(index), end: self.end.lane(index), coefficients }
    }

    /// At this part of the step, from 0 to 1.
    #[inline]
    pub(super) fn at(&self, part: S) -> S {
        let left = S::from(1.0) - part;
        let [first, second, third] = self.coefficients;
        left * self.start + part * (self.end + left * (first + part * (second + part * third)))
    }
}
