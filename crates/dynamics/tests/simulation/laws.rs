//! Systems with known solutions, and how the tests drive them.

use phea_dynamics::scalar::Scalar;
use phea_dynamics::simulation::{
    Input, InputSchedule, Method, Settings, Simulated, Status, System, simulate,
};

/// Rates without parameters of each lane, delays or indicators.
pub(crate) trait Law: Clone {
    const STATES: usize;
    const INPUTS: usize = 0;

    fn rates<T: Scalar>(&self, y: &[T], w: &[T], rates: &mut [T]);
}

/// A law as a system, with one scale for all its states.
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
}

/// y' = w
#[derive(Clone)]
pub(crate) struct Integral;

impl Law for Integral {
    const STATES: usize = 1;
    const INPUTS: usize = 1;

    fn rates<T: Scalar>(&self, _: &[T], w: &[T], rates: &mut [T]) {
        rates[0] = w[0];
    }
}

/// y' = lambda (y - w) + w',  y = w when begun there (Prothero and Robinson 1974)
#[derive(Clone)]
pub(crate) struct Following(pub(crate) f64);

impl Law for Following {
    const STATES: usize = 1;
    const INPUTS: usize = 2;

    fn rates<T: Scalar>(&self, y: &[T], w: &[T], rates: &mut [T]) {
        rates[0] = T::from(self.0) * (y[0] - w[0]) + w[1];
    }
}

/// y' = -w' y^2,  y = 1/(1/y_0 + w)
#[derive(Clone)]
pub(crate) struct Reciprocal;

impl Law for Reciprocal {
    const STATES: usize = 1;
    const INPUTS: usize = 2;

    fn rates<T: Scalar>(&self, y: &[T], w: &[T], rates: &mut [T]) {
        rates[0] = -w[0] * y[0].squared();
    }
}

/// x'' = -omega^2 x; the states are x and x'/omega
#[derive(Clone)]
pub(crate) struct Oscillator(pub(crate) f64);

impl Law for Oscillator {
    const STATES: usize = 2;

    fn rates<T: Scalar>(&self, y: &[T], _: &[T], rates: &mut [T]) {
        rates[0] = T::from(self.0) * y[1];
        rates[1] = T::from(-self.0) * y[0];
    }
}

pub(crate) fn course(duration_s: f64, output_step_s: f64, inputs: Vec<Input>) -> InputSchedule {
    InputSchedule { duration_s, output_step_s, inputs }
}

pub(crate) fn settings(tolerance: f64, method: Method) -> Settings {
    Settings { tolerance, method, ..Settings::default() }
}

/// Driven to its end by the implicit method.
pub(crate) fn run<E: System<f64> + Clone>(
    system: &E,
    start: &[f64],
    course: &InputSchedule,
    tolerance: f64,
) -> Simulated {
    run_by(Method::Rosenbrock, system, start, course, tolerance)
}

/// Driven to its end.
pub(crate) fn run_by<E: System<f64> + Clone>(
    method: Method,
    system: &E,
    start: &[f64],
    course: &InputSchedule,
    tolerance: f64,
) -> Simulated {
    let result = simulate(system, start, course, None, &settings(tolerance, method), &mut |_| true).unwrap();
    assert_eq!(result.outcome.status, Status::Completed, "{:?}", result.outcome.work);
    result
}

/// The greatest distance of one state from a function of time, over all rows.
pub(crate) fn distance(result: &Simulated, state: usize, exact: impl Fn(f64) -> f64) -> f64 {
    let rows = result.trajectory.times_s.iter().zip(&result.trajectory.states);
    rows.map(|(&time_s, row)| (row[state] - exact(time_s)).abs()).fold(0.0, f64::max)
}

/// The last row of one state.
pub(crate) fn last(result: &Simulated, state: usize) -> f64 {
    result.outcome.end[state]
}
