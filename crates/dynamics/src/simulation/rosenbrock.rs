//! Single step of an L-stable Rosenbrock method of order five.

use nalgebra::DMatrix;

use super::carried::{CARRIED, carried_weights};
use super::derivatives::DIRECTIONS;
use super::growth::AmplitudeLost;
use super::kernel::{Kernel, StepTrial};
use super::method::{Extension, StepInputs, relative_error};
use super::pattern::JacobianPattern;
use super::step_matrix::{COLUMN, ColumnIndex, StepMatrix};
use super::{Lane, System};
use crate::linear::irreducible_blocks;
use crate::scalar::{Dependence, Dual};

/// Number of stages.
const STAGES: usize = 8;

/// Product of step and rate beyond which the error inside a step is checked.
const STIFF: f64 = 1e3;

/// Coefficient gamma, on the diagonal of every stage.
const GAMMA: f64 = 0.21193756319429014;

/// Coefficients a_ij: contributions of earlier stages to the state of stages 2 to 6; the last two
/// stages each add the previous increment.
const A2: [f64; 1] = [3.0];
const A3: [f64; 2] = [2.849394379747939, 0.45842242204463923];
const A4: [f64; 3] = [-6.954028509809101, 2.489845061869568, -10.358996098473584];
const A5: [f64; 4] = [2.8029986275628964, 0.5072464736228206, -0.3988312541770524, -0.04721187230404641];
const A6: [f64; 5] =
    [-7.502846399306121, 2.561846144803919, -11.627539656261098, -0.18268767659942256, 0.030198172008377946];

/// Coefficients c_ij: contributions of earlier stages to the right-hand side of stages 2 to 8, over
/// h.
const C2: [f64; 1] = [-14.155112264123755];
const C3: [f64; 2] = [-17.97296035885952, -2.859693295451294];
const C4: [f64; 3] = [147.12150275711716, -1.41221402718213, 71.68940251302358];
const C5: [f64; 4] = [165.43517024871676, -0.4592823456491126, 42.90938336958603, -5.961986721573306];
const C6: [f64; 5] =
    [24.854864614690072, -3.0009227002832186, 47.4931110020768, 5.5814197821558125, -0.6610691825249471];
const C7: [f64; 6] = [
    30.91273214028599,
    -3.1208243349937974,
    77.79954646070892,
    34.28646028294783,
    -19.097331116725623,
    -28.087943162872662,
];
const C8: [f64; 7] = [
    37.80277123390563,
    -3.2571969029072276,
    112.26918849496327,
    66.9347231244047,
    -40.06618937091002,
    -54.66780262877968,
    -9.48861652309627,
];

/// Fractions of the step at which the inputs of each stage are taken.
pub(super) const STAGE_TIMES: [f64; 6] =
    [0.0, 0.6358126895828704, 0.4095798393397535, 0.9769306725060716, 0.4288403609558664, 1.0];

/// Coefficients d_i: weights of the slope in time.
const SLOPE_WEIGHTS: [f64; 5] =
    [0.21193756319429014, -0.42387512638858027, -0.3384627126235924, 1.8046452872882734, 2.325825639765069];

/// Coefficients h_ij of the continuous extension.
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

/// On the imaginary axis, ln |R(i theta)| = -c theta^8 + ...: too low by a fifth at 0.5 rad, too
/// high by a third at 1.5 rad.
pub(super) const AMPLITUDE_LOST: AmplitudeLost = AmplitudeLost { factor: 1.2e-5, power: 8 };

/// Source of an entry of the Jacobian.
#[derive(Clone, Copy, Debug)]
struct JacobianEntry {
    row: usize,
    /// Evaluation that finds it, and the direction.
    pass: usize,
    direction: usize,
    /// Position in the step's matrix.
    entry: usize,
}

/// Group of four states: whole vectors for the processor. The last group is padded with zeros.
type StateGroup<S> = [S; 4];

/// Method with its memory, for a system of one pattern.
///
/// ```text
/// (1/(h gamma) - J) u_i = f(y + sum a_ij u_j, t + alpha_i h) + sum c_ij u_j/h + h d_i df/dt
/// y(t + h) = y + sum b_i u_i,        error: u_8
/// ```
///
/// Order 5 with an embedded solution of order 4, both L-stable, stiffly accurate; continuous
/// extension of order 4. Source: Rodas5P, Steinebach (2023), BIT Numerical Mathematics 63, 27.
#[derive(Clone, Debug)]
pub(super) struct Rosenbrock<S> {
    pattern: JacobianPattern,
    matrix: StepMatrix<S>,
    /// Increments u_i of all stages, group by group.
    increments: Vec<[StateGroup<S>; STAGES]>,
    start: Vec<StateGroup<S>>,
    stage: Vec<StateGroup<S>>,
    rates: Vec<StateGroup<S>>,
    rates_of_stage: Vec<StateGroup<S>>,
    /// Right-hand side of a stage, and then its increment.
    column: Box<ColumnIndex<S>>,
    slopes: Vec<S>,
    slopes_between: Vec<S>,
    /// States as variables, for one evaluation after another.
    seeded: Vec<Vec<Dual<DIRECTIONS, S>>>,
    seeded_inputs: Vec<Dual<DIRECTIONS, S>>,
    seeded_rates: Vec<Dual<DIRECTIONS, S>>,
    /// Entries of J, in the order in which they are found.
    jacobian: Vec<S>,
    found: Vec<JacobianEntry>,
    /// Positions in J of the derivative of each state's rate with respect to that state, and the
    /// least of these derivatives.
    own: Vec<usize>,
    fastest: S,
    /// Weights of [`Rosenbrock::carry`].
    carried: [f64; CARRIED],
    /// State at the end of the last step.
    pub(super) end: Vec<S>,
}

impl<S: Lane> Rosenbrock<S> {
    /// Method for this system; `None` if it is too large to find its pattern.
    pub(super) fn new(system: &dyn Kernel<S>) -> Option<Self> {
        let pattern = system.pattern()?;
        let (states, inputs) = (system.states(), system.inputs());
        let (groups, zero) = (states.div_ceil(4), S::from(0.0));
        let seeded = |pass: usize| {
            let direction = |&colour: &usize| colour.wrapping_sub(pass * DIRECTIONS);
            pattern.colours.iter().map(|colour| Dual::variable(zero, direction(colour))).collect()
        };
        let seeded = (0..=pattern.colour_count / DIRECTIONS).map(seeded).collect();
        let matrix = StepMatrix::new(&pattern.rows);
        let found = found(&pattern, &matrix);
        Some(Rosenbrock {
            increments: vec![[[zero; 4]; STAGES]; groups],
            start: vec![[zero; 4]; groups],
            stage: vec![[zero; 4]; groups],
            rates: vec![[zero; 4]; groups],
            rates_of_stage: vec![[zero; 4]; groups],
            column: Box::new([zero; COLUMN]),
            slopes: vec![zero; states],
            slopes_between: vec![zero; states],
            seeded_inputs: vec![Dual::constant(zero); inputs],
            seeded_rates: vec![Dual::constant(zero); states],
            seeded,
            jacobian: vec![zero; found.len()],
            own: own(&pattern),
            carried: carried_weights(GAMMA),
            fastest: zero,
            found,
            end: vec![zero; states],
            matrix,
            pattern,
        })
    }

    /// Evaluates rates, Jacobian and slopes in time at the start of a step.
    #[inline(always)]
    pub(super) fn linearize<E: System<S>>(&mut self, system: &E, state: &[S], inputs: &StepInputs<S>)
    where
        Dependence: From<S>,
        Dual<DIRECTIONS, S>: From<f64> + From<S>,
    {
        // the slope in time is one more direction
        let in_time = self.pattern.colour_count;
        let directions = (in_time + usize::from(inputs.moving)).max(1);
        for (seeded, &value) in self.seeded_inputs.iter_mut().zip(&inputs.stages[0]) {
            *seeded = Dual::constant(value);
        }
        for (pass, seeded) in self.seeded.iter_mut().enumerate().take(directions.div_ceil(DIRECTIONS)) {
            let first = pass * DIRECTIONS;
            for (seeded, &value) in seeded.iter_mut().zip(state) {
                seeded.set_value(value);
            }
            let time_here = inputs.moving && (first..first + DIRECTIONS).contains(&in_time);
            if time_here {
                let at_start = self.seeded_inputs.iter_mut().zip(&inputs.slopes);
                for (seeded, &slope) in at_start {
                    let mut gradient = [S::from(0.0); DIRECTIONS];
                    gradient[in_time - first] = slope;
                    *seeded = Dual::new(seeded.value(), gradient);
                }
            }
            system.rates(seeded, &self.seeded_inputs, &mut self.seeded_rates);
            for (value, found) in self.jacobian.iter_mut().zip(&self.found) {
                if found.pass == pass {
                    *value = self.seeded_rates[found.row].gradient()[found.direction];
                }
            }
            if time_here {
                // without moving inputs the slope is not evaluated: an infinite derivative then
                // means no slope
                let zero = S::from(0.0);
                let moving = inputs.slopes.iter().fold(zero, |sum, slope| sum + slope.abs());
                for (slope, rate) in self.slopes.iter_mut().zip(&self.seeded_rates) {
                    *slope = S::select(zero.less_than(moving), rate.gradient()[in_time - first], zero);
                }
            }
        }
        for (value, rate) in self.rates.as_flattened_mut().iter_mut().zip(&self.seeded_rates) {
            *value = rate.value();
        }
        self.fastest = S::from(0.0);
        for &place in &self.own {
            self.fastest = self.fastest.minimum(self.jacobian[place]);
        }
    }

    /// Attempts a step of length h from the point at which [`Rosenbrock::linearize`] was called;
    /// returns the error of each lane in units of the tolerance. If the error is above one or NaN,
    /// the step must be repeated with a shorter length.
    #[inline(always)]
    pub(super) fn attempt<E: System<S>>(
        &mut self,
        system: &E,
        trial: StepTrial<'_, S>,
        inputs: &StepInputs<S>,
    ) -> S {
        let StepTrial { state, step, scales, tolerance } = trial;
        let per_step = S::from(1.0) / step;
        self.matrix.reset(per_step * S::from(1.0 / GAMMA));
        for (&value, found) in self.jacobian.iter().zip(&self.found) {
            self.matrix.subtract(found.entry, value);
        }
        let kept = self.matrix.factor();
        let states = state.len();
        for (start, &state) in self.start.as_flattened_mut().iter_mut().zip(state) {
            *start = state;
        }
        self.finish_stage(0, step, per_step, inputs.moving);
        for stage in 1..STAGES {
            self.begin_stage(stage);
            let at = stage.min(STAGE_TIMES.len() - 1);
            let rates = &mut self.rates_of_stage.as_flattened_mut()[..states];
            system.rates(&self.stage.as_flattened()[..states], &inputs.stages[at], rates);
            self.finish_stage(stage, step, per_step, inputs.moving);
        }
        // the column holds the last increment
        for ((end, &stage), &increment) in
            self.end.iter_mut().zip(self.stage.as_flattened()).zip(&*self.column)
        {
            *end = stage + increment;
        }
        let error = relative_error(&*self.column, state, &self.end, scales, tolerance);
        S::select(S::from(0.0).less_than(kept), error, S::from(f64::INFINITY))
    }

    /// True if a state of this lane would settle within a small fraction of the step, if the others
    /// were constant.
    pub(super) fn binds_stiffly(&self, lane: usize, step_s: f64) -> bool {
        self.fastest.lane(lane) * step_s < -STIFF
    }

    /// Error of the continuous extension at a fraction theta of the step just attempted, in units
    /// of the tolerance, for the inputs there: the residual of the equations, converted to the
    /// state like a stage's increment.
    ///
    /// ```text
    /// (1/(h gamma) - J) e = f(y(theta), w(theta)) - y'(theta)
    /// ```
    ///
    /// For a state that is stiffly coupled to others or to an input, the error at the end does not
    /// show the error inside the step.
    #[inline(always)]
    pub(super) fn error_between<E: System<S>>(
        &mut self,
        system: &E,
        trial: StepTrial<'_, S>,
        (part, inputs): (S, &[S]),
    ) -> S {
        let StepTrial { state, step, scales, tolerance } = trial;
        let (states, per_step) = (state.len(), S::from(1.0) / step);
        for (index, &start) in state.iter().enumerate() {
            let extension = self.extension(index, start);
            self.stage.as_flattened_mut()[index] = extension.at(part);
            self.slopes_between[index] = extension.slope(part) * per_step;
        }
        let remainders = &mut *self.column;
        system.rates(&self.stage.as_flattened()[..states], inputs, &mut remainders[..states]);
        for (remainder, &slope) in remainders.iter_mut().zip(&self.slopes_between) {
            *remainder = *remainder - slope;
        }
        self.matrix.solve(remainders);
        relative_error(remainders, state, &self.end, scales, tolerance)
    }

    /// Propagates a small error of the state over the step just attempted, by the matrix that was
    /// factored for it.
    ///
    /// ```text
    /// R(h J) e,     R(z) = P(z)/(1 - gamma z)^6 = sum of b_k w^k, k from 1 to 6,   w = 1/(1 - gamma z)
    /// ```
    ///
    /// P is (1 - gamma z)^6 exp(z) up to z^5, which makes R L-stable and of order 5. Source: Hairer
    /// and Wanner (1996), section IV.6, restricted Pade approximations.
    #[inline(always)]
    pub(super) fn carry(&mut self, step: S, error: &mut [S]) {
        let per_step = S::from(1.0 / GAMMA) / step;
        self.column.fill(S::from(0.0));
        for weight in self.carried.iter().rev() {
            for (value, &error) in self.column.iter_mut().zip(&*error) {
                *value = (*value + error.times(*weight)) * per_step;
            }
            self.matrix.solve(&mut self.column);
        }
        error.copy_from_slice(&self.column[..error.len()]);
    }

    /// Sum y + sum a_ij u_j.
    #[inline(always)]
    fn begin_stage(&mut self, stage: usize) {
        let one = S::from(1.0);
        let (sums, start, increments) = (&mut self.stage[..], &self.start[..], &self.increments[..]);
        match stage {
            1 => combine(sums, start, &A2, one, increments),
            2 => combine(sums, start, &A3, one, increments),
            3 => combine(sums, start, &A4, one, increments),
            4 => combine(sums, start, &A5, one, increments),
            5 => combine(sums, start, &A6, one, increments),
            // the column holds the previous increment
            _ => {
                for (value, &increment) in sums.as_flattened_mut().iter_mut().zip(&*self.column) {
                    *value = *value + increment;
                }
            }
        }
    }

    /// Increment of a stage from its rates.
    #[inline(always)]
    fn finish_stage(&mut self, stage: usize, step: S, per_step: S, moving: bool) {
        let (column, _) = self.column.as_chunks_mut();
        let (rates, before) = (&self.rates_of_stage[..], &self.increments[..]);
        match stage {
            1 => combine(column, rates, &C2, per_step, before),
            2 => combine(column, rates, &C3, per_step, before),
            3 => combine(column, rates, &C4, per_step, before),
            4 => combine(column, rates, &C5, per_step, before),
            5 => combine(column, rates, &C6, per_step, before),
            6 => combine(column, rates, &C7, per_step, before),
            7 => combine(column, rates, &C8, per_step, before),
            _ => column.iter_mut().zip(&self.rates).for_each(|(right, rates)| *right = *rates),
        }
        if let Some(&weight) = SLOPE_WEIGHTS.get(stage).filter(|_| moving) {
            let weighted = step.times(weight);
            for (right, &slope) in self.column.iter_mut().zip(&self.slopes) {
                *right = *right + weighted * slope;
            }
        }
        self.matrix.solve(&mut self.column);
        let (column, _) = self.column.as_chunks();
        for (increments, column) in self.increments.iter_mut().zip(column) {
            increments[stage] = *column;
        }
    }

    /// One state over the last step.
    #[inline(always)]
    pub(super) fn extension(&self, index: usize, start: S) -> Extension<S> {
        let mut coefficients = [S::from(0.0); 3];
        for (stage, increments) in self.increments[index / 4].iter().enumerate() {
            for (coefficient, weights) in coefficients.iter_mut().zip(&EXTENSION) {
                *coefficient = *coefficient + increments[index % 4].times(weights[stage]);
            }
        }
        Extension { start, end: self.end[index], coefficients }
    }
}

impl<S: Lane> Rosenbrock<S> {
    /// Sets of states that all influence each other.
    pub(super) fn blocks(&self) -> Vec<Vec<usize>> {
        let mut pattern = DMatrix::zeros(self.end.len(), self.end.len());
        for (row, column, _) in self.jacobian_entries() {
            pattern[(row, column)] = 1.0;
        }
        irreducible_blocks(&pattern)
    }

    /// Position of the entry in a row and a column of the Jacobian; `None` if it is zero for any
    /// state.
    pub(super) fn place(&self, row: usize, column: usize) -> Option<usize> {
        let before: usize = self.pattern.rows.iter().take(row).map(Vec::len).sum();
        let place = self.pattern.rows.get(row)?.iter().position(|&other| other == column)?;
        Some(before + place)
    }

    /// Entry of the Jacobian at this position, in one lane.
    pub(super) fn jacobian_at(&self, place: usize, lane: usize) -> f64 {
        self.jacobian.get(place).map_or(0.0, |value| value.lane(lane))
    }

    /// Row, column and value of every entry of the Jacobian that can differ from zero.
    pub(super) fn jacobian_entries(&self) -> impl Iterator<Item = (usize, usize, S)> + '_ {
        let places = self.pattern.rows.iter().enumerate();
        let places = places.flat_map(|(row, columns)| columns.iter().map(move |&column| (row, column)));
        places.zip(&self.jacobian).map(|((row, column), &value)| (row, column, value))
    }
}

/// Sum base + factor sum w_j u_j over the first K stages.
#[inline(always)]
fn combine<S: Lane, const K: usize>(
    sums: &mut [StateGroup<S>],
    base: &[StateGroup<S>],
    weights: &[f64; K],
    factor: S,
    increments: &[[StateGroup<S>; STAGES]],
) {
    for ((sums, base), increments) in sums.iter_mut().zip(base).zip(increments) {
        let mut totals = [S::from(0.0); 4];
        for (stage, &weight) in increments.iter().zip(weights) {
            for (total, &increment) in totals.iter_mut().zip(stage) {
                *total = *total + increment.times(weight);
            }
        }
        for ((sum, &base), &total) in sums.iter_mut().zip(base).zip(&totals) {
            *sum = base + factor * total;
        }
    }
}

/// Source and position of each entry of the pattern.
fn found<S: Lane>(pattern: &JacobianPattern, matrix: &StepMatrix<S>) -> Vec<JacobianEntry> {
    let mut all = Vec::new();
    for (row, columns) in pattern.rows.iter().enumerate() {
        for (place, &column) in columns.iter().enumerate() {
            let colour = pattern.colours[column];
            let (pass, direction) = (colour / DIRECTIONS, colour % DIRECTIONS);
            all.push(JacobianEntry { row, pass, direction, entry: matrix.entry(row, place) });
        }
    }
    all
}

/// Positions of the diagonal among the entries of the pattern.
fn own(pattern: &JacobianPattern) -> Vec<usize> {
    let rows = pattern.rows.iter().enumerate();
    let places = rows.flat_map(|(row, columns)| columns.iter().map(move |&column| row == column));
    places.enumerate().filter_map(|(place, own)| own.then_some(place)).collect()
}
