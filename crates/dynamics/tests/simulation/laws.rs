//! Systems with known solutions, and their simulation in the tests.

use phea_dynamics::expression::{Expression, Recorded};
use phea_dynamics::scalar::Scalar;
use phea_dynamics::simulation::{
    self, Input, InputSchedule, Method, Sampler, Simulated, SimulationError, SimulationSettings, Sliding,
    Status, System,
};

/// Rates without parameters of each lane, delays or indicators.
pub(crate) trait Law: Clone {
    const STATES: usize;
    const INPUTS: usize = 0;
    const KINKS: usize = 0;

    fn rates<T: Scalar>(&self, y: &[T], w: &[T], rates: &mut [T]);

    fn mark<T: Scalar>(&self, _y: &[T], _w: &[T], _marks: &mut [T]) {}
}

/// Law as a system, with one scale for all its states.
#[derive(Clone)]
pub(crate) struct Lawful<L>(pub(crate) L, pub(crate) f64);

impl<L: Law> System<f64> for Lawful<L> {
    fn states(&self) -> usize {
        L::STATES
    }
    fn inputs(&self) -> usize {
        L::INPUTS
    }
    fn scales(&self) -> Vec<f64> {
        vec![self.1; L::STATES]
    }
    fn rates<T: Scalar + From<f64>>(&self, y: &[T], w: &[T], rates: &mut [T]) {
        self.0.rates(y, w, rates);
    }
    fn kinks(&self) -> usize {
        L::KINKS
    }
    fn mark<T: Scalar + From<f64>>(&self, y: &[T], w: &[T], marks: &mut [T]) {
        self.0.mark(y, w, marks);
    }
}

/// System with recorded equations: the methods, which are compiled for each type of system, are
/// compiled once for all of them.
#[derive(Clone)]
struct Recording {
    scales: Vec<f64>,
    delays: Vec<f64>,
    sliding: Option<Sliding>,
    inputs: usize,
    indicators: usize,
    rates: Expression,
    outgoing: Expression,
    indicate: Expression,
    kinks: usize,
    mark: Expression,
}

impl Recording {
    fn of<E: System<f64>>(system: &E) -> Recording {
        let (states, inputs) = (system.states(), system.inputs());
        let (delays, indicators) = (system.delays(), system.indicators());
        Recording {
            rates: recorded(states, inputs, states, &mut |y, w, rates| system.rates(y, w, rates)),
            outgoing: recorded(states, inputs, delays.len(), &mut |y, w, waves| system.outgoing(y, w, waves)),
            mark: recorded(states, inputs, system.kinks(), &mut |y, w, marks| system.mark(y, w, marks)),
            kinks: system.kinks(),
            indicate: recorded(states, inputs, indicators, &mut |y, w, found| system.indicate(y, w, found)),
            scales: system.scales(),
            sliding: system.sliding(),
            inputs,
            delays,
            indicators,
        }
    }
}

/// Functions of states and inputs that write their results.
type Equations<'a> =
    &'a mut dyn for<'tape> FnMut(&[Recorded<'tape>], &[Recorded<'tape>], &mut [Recorded<'tape>]);

/// Given number of functions of states and inputs.
fn recorded(states: usize, inputs: usize, results: usize, equations: Equations<'_>) -> Expression {
    Expression::record(&vec![""; states + inputs], |parameters| {
        let mut found = vec![Recorded::from(f64::NAN); results];
        let (states, inputs) = parameters.split_at(states);
        equations(states, inputs, &mut found);
        found
    })
}

fn evaluate<T: Scalar>(expression: &Expression, y: &[T], w: &[T], results: &mut [T]) {
    results.copy_from_slice(&expression.evaluate(&[y, w].concat()));
}

impl System<f64> for Recording {
    fn states(&self) -> usize {
        self.scales.len()
    }
    fn inputs(&self) -> usize {
        self.inputs
    }
    fn scales(&self) -> Vec<f64> {
        self.scales.clone()
    }
    fn rates<T: Scalar + From<f64>>(&self, y: &[T], w: &[T], rates: &mut [T]) {
        evaluate(&self.rates, y, w, rates);
    }
    fn delays(&self) -> Vec<f64> {
        self.delays.clone()
    }
    fn outgoing<T: Scalar + From<f64>>(&self, y: &[T], w: &[T], waves: &mut [T]) {
        evaluate(&self.outgoing, y, w, waves);
    }
    fn indicators(&self) -> usize {
        self.indicators
    }
    fn sliding(&self) -> Option<Sliding> {
        self.sliding
    }
    fn indicate<T: Scalar + From<f64>>(&self, y: &[T], w: &[T], indicators: &mut [T]) {
        evaluate(&self.indicate, y, w, indicators);
    }
    fn kinks(&self) -> usize {
        self.kinks
    }
    fn mark<T: Scalar + From<f64>>(&self, y: &[T], w: &[T], marks: &mut [T]) {
        evaluate(&self.mark, y, w, marks);
    }
}

/// Simulation as in [`simulation::simulate`], from the recorded equations of the system.
pub(crate) fn simulate<E: System<f64>>(
    system: &E,
    start: &[f64],
    schedule: &InputSchedule,
    sampler: Option<Box<dyn Sampler + '_>>,
    settings: &SimulationSettings,
    watch: &mut dyn FnMut(f64) -> bool,
) -> Result<Simulated, SimulationError> {
    simulation::simulate(&Recording::of(system), start, schedule, sampler, settings, watch)
}

/// Equation y' = w.
#[derive(Clone)]
pub(crate) struct Integral;

impl Law for Integral {
    const STATES: usize = 1;
    const INPUTS: usize = 1;

    fn rates<T: Scalar>(&self, _: &[T], w: &[T], rates: &mut [T]) {
        rates[0] = w[0];
    }
}

/// Equation y' = lambda (y - w) + w', with solution y = w if y starts at w (Prothero and Robinson
/// 1974).
#[derive(Clone)]
pub(crate) struct Following(pub(crate) f64);

impl Law for Following {
    const STATES: usize = 1;
    const INPUTS: usize = 2;

    fn rates<T: Scalar>(&self, y: &[T], w: &[T], rates: &mut [T]) {
        rates[0] = T::from(self.0) * (y[0] - w[0]) + w[1];
    }
}

/// Equation y' = -w' y^2, with solution y = 1/(1/y_0 + w).
#[derive(Clone)]
pub(crate) struct Reciprocal;

impl Law for Reciprocal {
    const STATES: usize = 1;
    const INPUTS: usize = 2;

    fn rates<T: Scalar>(&self, y: &[T], w: &[T], rates: &mut [T]) {
        rates[0] = -w[0] * y[0].squared();
    }
}

/// Oscillator x'' = -omega^2 x; the states are x and x'/omega.
#[derive(Clone)]
pub(crate) struct Oscillator(pub(crate) f64);

impl Law for Oscillator {
    const STATES: usize = 2;

    fn rates<T: Scalar>(&self, y: &[T], _: &[T], rates: &mut [T]) {
        rates[0] = T::from(self.0) * y[1];
        rates[1] = T::from(-self.0) * y[0];
    }
}

pub(crate) fn schedule(duration_s: f64, output_step_s: f64, inputs: Vec<Input>) -> InputSchedule {
    InputSchedule { duration_s, output_step_s, inputs }
}

pub(crate) fn settings(tolerance: f64, method: Method) -> SimulationSettings {
    SimulationSettings { tolerance, method, ..SimulationSettings::default() }
}

/// Simulates to the end by the implicit method.
pub(crate) fn run<E: System<f64> + Clone>(
    system: &E,
    start: &[f64],
    schedule: &InputSchedule,
    tolerance: f64,
) -> Simulated {
    run_by(Method::Rosenbrock, system, start, schedule, tolerance)
}

/// Simulates to the end.
pub(crate) fn run_by<E: System<f64> + Clone>(
    method: Method,
    system: &E,
    start: &[f64],
    schedule: &InputSchedule,
    tolerance: f64,
) -> Simulated {
    let result =
        simulate(system, start, schedule, None, &settings(tolerance, method), &mut |_| true).unwrap();
    assert_eq!(result.outcome.status, Status::Completed, "{:?}", result.outcome.work);
    result
}

/// Greatest distance of one state from a function of time, over all rows.
pub(crate) fn distance(result: &Simulated, state: usize, exact: impl Fn(f64) -> f64) -> f64 {
    let rows = result.trajectory.times_s.iter().zip(&result.trajectory.states);
    rows.map(|(&time_s, row)| (row[state] - exact(time_s)).abs()).fold(0.0, f64::max)
}

/// Last row of one state.
pub(crate) fn last(result: &Simulated, state: usize) -> f64 {
    result.outcome.end[state]
}
