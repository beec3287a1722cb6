//! Stiff systems: damping at infinity, published solutions.

use nalgebra::{DMatrix, DVector};
use phea_dynamics::linear::{StateSpace, TimeDomain};
use phea_dynamics::portable;
use phea_dynamics::scalar::Scalar;
use phea_dynamics::simulation::{Input, Profile, System};
use phea_dynamics::time_response::{SampledSignal, forced_response_of_states};

use super::laws::{Following, Law, Lawful, distance, last, run, schedule};

/// Equation y' = lambda y.
#[derive(Clone)]
struct Decay(f64);

impl Law for Decay {
    const STATES: usize = 1;

    fn rates<T: Scalar>(&self, y: &[T], _: &[T], rates: &mut [T]) {
        rates[0] = T::from(self.0) * y[0];
    }
}

/// A single step of 1 s, without error control: R(h lambda) tends to zero.
#[test]
fn a_fast_mode_is_gone_after_one_step() {
    for (rate, left) in [(-1e6, 1e-4), (-1e9, 1e-7), (-1e12, 1e-10)] {
        let result = run(&Lawful(Decay(rate), 1e15), &[1.0], &schedule(1.0, 1.0, vec![]), 0.5);
        assert_eq!(result.outcome.work.steps, 1);
        assert!(last(&result, 0).abs() < left, "{rate}: {}", last(&result, 0));
    }
}

#[test]
fn a_fast_mode_restricts_no_step() {
    for rate in [-1e3, -1e6, -1e9, -1e12] {
        let result = run(&Lawful(Decay(rate), 1.0), &[1.0], &schedule(1.0, 0.5, vec![]), 1e-6);
        assert!(result.outcome.work.steps < 60, "{rate}: {:?}", result.outcome.work);
        assert!(last(&result, 0).abs() < 1e-6, "{rate}: {}", last(&result, 0));
    }
}

/// y follows w = sin(3 t) exactly, however stiffly it is coupled to it.
#[test]
fn a_stiffly_coupled_state_follows() {
    let sine = Profile::sine(0.0, 1.0, 3.0).unwrap();
    let schedule = schedule(4.0, 0.013, vec![Input::Value(sine.clone()), Input::Rate(sine)]);
    for tolerance in [1e-5, 1e-8] {
        let mild = run(&Lawful(Following(-1.0), 1.0), &[0.0], &schedule, tolerance).outcome.work;
        for rate in [-1.0, -1e2, -1e4, -1e6, -1e9] {
            let result = run(&Lawful(Following(rate), 1.0), &[0.0], &schedule, tolerance);
            let at_end = (last(&result, 0) - portable::sin(12.0)).abs();
            assert!(at_end < tolerance, "{rate}: {at_end} at {tolerance}");
            let between = distance(&result, 0, |time_s| portable::sin(3.0 * time_s));
            assert!(between < 20.0 * tolerance, "{rate}: {between} at {tolerance}");
            let work = result.outcome.work;
            assert!(work.steps < 3 * mild.steps, "{rate}: {work:?}, mild: {mild:?}");
        }
    }
}

/// Equations y_1' = y_2,  y_2' = ((1 - y_1^2) y_2 - y_1)/epsilon: mu = 1e3 in the time of the
/// relaxation.
#[derive(Clone)]
struct VanDerPol;

impl Law for VanDerPol {
    const STATES: usize = 2;

    fn rates<T: Scalar>(&self, y: &[T], _: &[T], rates: &mut [T]) {
        rates[0] = y[1];
        rates[1] = ((T::from(1.0) - y[0].squared()) * y[1] - y[0]) / T::from(1e-6);
    }
}

#[test]
fn van_der_pols_relaxation() {
    // ORIGIN: Mazzia and Magherini, Test Set for Initial Value Problem Solvers (2008), problem
    // VDPOL
    let published = [1.706167732170483, -0.8928097010247975];
    for (tolerance, allowed) in [(1e-4, 2e-3), (1e-6, 2e-5), (1e-9, 2e-8)] {
        let result = run(&Lawful(VanDerPol, 1.0), &[2.0, 0.0], &schedule(2.0, 0.01, vec![]), tolerance);
        for (index, value) in published.into_iter().enumerate() {
            assert!((last(&result, index) - value).abs() < allowed, "{:?}", result.outcome);
        }
        assert!(result.outcome.work.steps < 6000, "{:?}", result.outcome.work);
    }
}

/// Three reactions with rates 0.04, 3e7 and 1e4.
#[derive(Clone)]
struct Robertson;

impl System<f64> for Robertson {
    fn states(&self) -> usize {
        3
    }
    fn inputs(&self) -> usize {
        0
    }
    fn scales(&self) -> Vec<f64> {
        vec![1e-9, 1e-14, 1e-2]
    }
    fn rates<T: Scalar + From<f64>>(&self, y: &[T], _: &[T], rates: &mut [T]) {
        let first = T::from(0.04) * y[0] - T::from(1e4) * y[1] * y[2];
        let second = T::from(3e7) * y[1].squared();
        rates.copy_from_slice(&[-first, first - second, second]);
    }
}

#[test]
fn robertsons_reactions() {
    // ORIGIN: Mazzia and Magherini, Test Set for Initial Value Problem Solvers (2008), problem
    // ROBER
    let published = [0.2083340149701255e-7, 0.8333360770334713e-13, 0.999999979166505];
    let result = run(&Robertson, &[1.0, 0.0, 0.0], &schedule(1e11, 1e10, vec![]), 1e-8);
    for (index, value) in published.into_iter().enumerate() {
        assert!((last(&result, index) / value - 1.0).abs() < 1e-5, "{:?}", result.outcome);
    }
    assert!(result.outcome.work.steps < 1000, "{:?}", result.outcome.work);
    for row in &result.trajectory.states {
        assert!((row.iter().sum::<f64>() - 1.0).abs() < 1e-9);
    }
}

/// Equation y' = A y + B w.
#[derive(Clone)]
struct Linear {
    a: DMatrix<f64>,
    b: DMatrix<f64>,
}

impl System<f64> for Linear {
    fn states(&self) -> usize {
        self.a.nrows()
    }
    fn inputs(&self) -> usize {
        self.b.ncols()
    }
    fn scales(&self) -> Vec<f64> {
        vec![1.0; self.a.nrows()]
    }
    fn rates<T: Scalar + From<f64>>(&self, y: &[T], w: &[T], rates: &mut [T]) {
        for (row, rate) in rates.iter_mut().enumerate() {
            let own = y.iter().enumerate().map(|(column, &y)| y.times(self.a[(row, column)]));
            let driven = w.iter().enumerate().map(|(column, &w)| w.times(self.b[(row, column)]));
            *rate = own.chain(driven).fold(T::from(0.0), |sum, term| sum + term);
        }
    }
}

/// Seven states need more colours than one evaluation has directions; modes at 1, 30 and 1e5 rad/s.
#[test]
fn a_linear_system_responds_as_its_matrix_exponential() {
    let size = 7;
    let a = DMatrix::from_fn(size, size, |row, column| {
        let mixed = portable::sin((3 * row + 5 * column + 1) as f64);
        if row == column { [-1.0, -2.0, -3.0, -30.0, -40.0, -1e5, -2e5][row] } else { mixed }
    });
    let b = DMatrix::from_fn(size, 1, |row, _| portable::cos(row as f64));
    let c = DMatrix::identity(size, size);
    let d = DMatrix::zeros(size, 1);
    let states = StateSpace::new(a.clone(), b.clone(), c, d, TimeDomain::Continuous).unwrap();
    let start: Vec<f64> = (0..size).map(|row| portable::cos(2.0 * row as f64)).collect();
    let inputs = vec![Input::Value(Profile::steps(0.5, &[(1.03, -2.0)]).unwrap())];
    let result = run(&Linear { a, b }, &start, &schedule(3.0, 0.05, inputs), 1e-10);
    let hold = phea_dynamics::time_response::Interpolation::Hold;
    let signal = SampledSignal::new(vec![0.0, 1.03], vec![0.5, -2.0], hold).unwrap();
    let times = &result.trajectory.times_s;
    let exact = forced_response_of_states(&states, &DVector::from_vec(start), &[signal], times).unwrap();
    for (row, exact) in result.trajectory.states.iter().zip(&exact) {
        for (value, exact) in row.iter().zip(exact.iter()) {
            assert!((value - exact).abs() < 1e-8, "{value} {exact}");
        }
    }
}
