//! A held command: linear plants compared with their exact discretisation.

use nalgebra::{DMatrix, DVector};
use phea_dynamics::linear::{Discretization, StateSpace, TimeDomain, TransferFunction};
use phea_dynamics::scalar::Scalar;
use phea_dynamics::simulation::{CommandedPlant, Input, Method, Plant, Profile, Sampler, Status};

use super::laws::{Integral, Lawful, schedule, settings, simulate};

/// A mass on a spring, driven through a lag, in units of `rate` rad/s: F = 3 x, times 1/rate.
#[derive(Clone)]
struct Spring {
    rate: f64,
}

impl Spring {
    fn system(&self) -> StateSpace {
        let a = DMatrix::from_row_slice(3, 3, &[0.0, 1.0, 0.0, -4.0, -0.3, 2.0, 0.0, 0.0, -5.0]);
        let b = DMatrix::from_row_slice(3, 1, &[0.0, 0.0, 5.0]);
        let c = DMatrix::from_row_slice(1, 3, &[3.0, 0.0, 0.0]);
        let d = DMatrix::zeros(1, 1);
        StateSpace::new(a * self.rate, b * self.rate, c, d, TimeDomain::Continuous).unwrap()
    }
}

impl Plant<f64> for Spring {
    fn states(&self) -> usize {
        3
    }
    fn inputs(&self) -> usize {
        0
    }
    fn scales(&self) -> Vec<f64> {
        vec![1.0; 3]
    }
    fn command_scale(&self) -> f64 {
        1.0
    }
    fn measurement_scale(&self) -> f64 {
        3.0
    }
    fn rates<T: Scalar + From<f64>>(&self, y: &[T], u: T, _: &[T], rates: &mut [T]) {
        rates[0] = y[1];
        rates[1] = y[2].times(2.0) - y[0].times(4.0) - y[1].times(0.3);
        rates[2] = (u - y[2]).times(5.0);
        for rate in rates.iter_mut() {
            *rate = rate.times(self.rate);
        }
    }
    fn measurement<T: Scalar + From<f64>>(&self, y: &[T], _: &[T]) -> T {
        y[0].times(3.0)
    }
}

/// Control law u_k = 0.2 e_k + 0.05 sum of e, with a record of its inputs and outputs.
struct Integrating<'a> {
    sample_time_s: f64,
    delay_s: f64,
    sum: f64,
    seen: &'a mut Vec<[f64; 3]>,
}

fn answer(sum: &mut f64, error: f64) -> f64 {
    *sum += error;
    0.2 * error + 0.05 * *sum
}

impl Sampler for Integrating<'_> {
    fn sample_time_s(&self) -> f64 {
        self.sample_time_s
    }
    fn delay_s(&self) -> f64 {
        self.delay_s
    }
    fn command(&mut self, time_s: f64, state: &[f64], inputs: &[f64]) -> f64 {
        let measured = 3.0 * state[0];
        let command = answer(&mut self.sum, inputs[1] - measured);
        self.seen.push([time_s, measured, command]);
        command
    }
}

/// Reference solution by matrix exponentials: from each sample to the arrival of a command, and on
/// to the next sample.
fn exactly(spring: &Spring, sample_time_s: f64, delay_s: f64, samples: usize) -> Vec<[f64; 3]> {
    let system = spring.system();
    let whole = (delay_s / sample_time_s + 1e-9).floor();
    let fraction_s = (delay_s - whole * sample_time_s).max(0.0);
    let whole = whole as usize;
    let passed = |state: DVector<f64>, length_s: f64, command: f64| {
        if length_s < 1e-9 * sample_time_s {
            return state;
        }
        let step = system.discretized(length_s, Discretization::ZeroOrderHold).unwrap();
        step.a() * state + step.b() * DVector::from_element(1, command)
    };
    let (mut state, mut sum) = (DVector::zeros(3), 0.0);
    let (mut seen, mut held): (Vec<[f64; 3]>, f64) = (Vec::new(), 0.0);
    for sample in 0..samples {
        let measured = (system.c() * &state)[(0, 0)];
        let command = answer(&mut sum, 1.0 - measured);
        seen.push([sample as f64 * sample_time_s, measured, command]);
        state = passed(state, fraction_s, held);
        held = sample.checked_sub(whole).and_then(|sent| seen.get(sent)).map_or(0.0, |row| row[2]);
        state = passed(state, sample_time_s - fraction_s, held);
    }
    seen
}

#[track_caller]
fn check(sample_time_s: f64, delay_s: f64, samples: usize) {
    let spring = Spring { rate: 0.2 / sample_time_s };
    let plant = CommandedPlant::on_hold(spring.clone(), &TransferFunction::gain_only(1.0)).unwrap();
    let mut seen = Vec::new();
    let sampler = Box::new(Integrating { sample_time_s, delay_s, sum: 0.0, seen: &mut seen });
    let duration_s = (samples as f64 - 0.5) * sample_time_s;
    let inputs = vec![Input::Command, Input::Value(Profile::constant(1.0))];
    let schedule = schedule(duration_s, 0.3 * sample_time_s, inputs);
    let settings = settings(1e-11, Method::Rosenbrock);
    let result = simulate(&plant, &[0.0; 3], &schedule, Some(sampler), &settings, &mut |_| true).unwrap();
    assert_eq!(result.outcome.status, Status::Completed);
    let exact = exactly(&spring, sample_time_s, delay_s, samples);
    assert_eq!(seen.len(), exact.len());
    for (one, other) in seen.iter().zip(&exact) {
        assert!((one[0] - other[0]).abs() < 1e-12 * duration_s);
        for (value, exact) in one.iter().zip(other) {
            assert!((value - exact).abs() < 1e-9, "{one:?} {other:?}, delay {delay_s}");
        }
    }
    assert!(seen.iter().any(|row| row[1] > 1.1), "the reference is overshot: {seen:?}");
}

#[test]
fn without_delay() {
    check(0.1, 0.0, 80);
    check(1e-3, 0.0, 80);
}

#[test]
fn within_a_sample() {
    check(0.1, 0.03, 80);
    check(1e-3, 0.97e-3, 80);
}

#[test]
fn a_whole_sample_and_longer() {
    check(0.1, 0.1, 80);
    check(1e-3, 1e-3, 80);
    check(0.1, 0.25, 80);
    check(1e-3, 3.5e-3, 80);
    check(1e-3, 4e-3, 80);
}

#[test]
fn a_million_samples_a_second() {
    check(1e-6, 0.0, 200);
    check(1e-6, 0.3e-6, 200);
    check(1e-6, 2.7e-6, 200);
}

/// A delay too short for any step to end within it.
#[test]
fn a_delay_below_rounding_is_ignored() {
    check(0.1, 1e-19, 40);
}

/// Rows at the samples show the command that applies afterwards.
#[test]
fn rows_show_the_command_that_is_held() {
    let plant = CommandedPlant::on_hold(Spring { rate: 1.0 }, &TransferFunction::gain_only(1.0)).unwrap();
    let mut seen = Vec::new();
    let sampler = Box::new(Integrating { sample_time_s: 0.1, delay_s: 0.0, sum: 0.0, seen: &mut seen });
    let schedule = schedule(2.0, 0.1, vec![Input::Command, Input::Value(Profile::constant(1.0))]);
    let result = simulate(
        &plant,
        &[0.0; 3],
        &schedule,
        Some(sampler),
        &settings(1e-6, Method::Rosenbrock),
        &mut |_| true,
    )
    .unwrap();
    assert_eq!((seen.len(), result.trajectory.times_s.len()), (20, 21));
    for (row, seen) in result.trajectory.inputs.iter().zip(&seen) {
        assert_eq!(row[0], seen[2]);
    }
}

/// A step of the reference at a whole number of samples acts at that sample, whatever the rounding
/// of the two times: its transient is that of any other, shifted.
#[test]
fn a_step_at_a_sample_acts_there() {
    let plant = CommandedPlant::on_hold(Spring { rate: 300.0 }, &TransferFunction::gain_only(1.0)).unwrap();
    let commands = |tenths: u32, samples: u32| {
        let sample_time_s = f64::from(tenths) / 1e4;
        let mut seen = Vec::new();
        let sampler = Box::new(Integrating { sample_time_s, delay_s: 0.0, sum: 0.0, seen: &mut seen });
        // the decimal fraction, rounded once
        let step_s = f64::from(tenths * samples) / 1e4;
        let reference = Profile::steps(0.0, &[(step_s, 1.0)]).unwrap();
        let schedule = schedule(0.3, 0.3, vec![Input::Command, Input::Value(reference)]);
        let settings = settings(1e-10, Method::Rosenbrock);
        simulate(&plant, &[0.0; 3], &schedule, Some(sampler), &settings, &mut |_| true).unwrap();
        let (still, moving) = seen.split_at(samples as usize);
        assert!(still.iter().all(|row| row[2] == 0.0), "{samples}");
        moving.iter().take(50).map(|row| row[2]).collect::<Vec<f64>>()
    };
    // tenths of a millisecond, with the product rounded to either side of the decimal fraction
    for (tenths, below) in [(7, true), (11, false)] {
        let decimal = |samples: u32| f64::from(tenths * samples) / 1e4;
        let off = (1..200).map(|samples| f64::from(samples) * decimal(1) - decimal(samples));
        assert!(off.filter(|off| *off != 0.0).map(|off| off < 0.0).any(|found| found == below), "{tenths}");
        let expected = commands(tenths, 16);
        for samples in 1..200 {
            for (one, other) in commands(tenths, samples).iter().zip(&expected) {
                assert!((one - other).abs() < 1e-8, "{samples} of {tenths}: {one} {other}");
            }
        }
    }
}

/// A row at a break, within rounding, shows the values after it.
#[test]
fn a_row_at_a_break_shows_what_follows() {
    for rows in 1..300_u32 {
        let step_s = f64::from(7 * rows) / 1e4;
        let reference = Profile::steps(0.0, &[(step_s, 1.0)]).unwrap();
        let schedule = schedule(0.25, 0.7e-3, vec![Input::Value(reference)]);
        let settings = settings(1e-6, Method::Rosenbrock);
        let law = Lawful(Integral, 1.0);
        let result = simulate(&law, &[0.0], &schedule, None, &settings, &mut |_| true).unwrap();
        let before = result.trajectory.inputs.iter().take_while(|inputs| inputs[0] == 0.0).count();
        assert_eq!(before, rows as usize);
    }
}

/// Plant like a pendulum whose stiffness increases with its amplitude, with a valve that closes.
///
/// ```text
/// x' = v,   v' = z - 9 x - 4 x^3 - |v| v,   z' = (u - z) sqrt(1 + z^2) 8
/// ```
#[derive(Clone)]
struct Bent;

impl Plant<f64> for Bent {
    fn states(&self) -> usize {
        3
    }
    fn inputs(&self) -> usize {
        0
    }
    fn scales(&self) -> Vec<f64> {
        vec![0.3, 1.0, 3.0]
    }
    fn command_scale(&self) -> f64 {
        3.0
    }
    fn measurement_scale(&self) -> f64 {
        1.0
    }
    fn rates<T: Scalar + From<f64>>(&self, y: &[T], u: T, _: &[T], rates: &mut [T]) {
        rates[0] = y[1];
        rates[1] = y[2] - y[0].times(9.0) - y[0].squared() * y[0].times(4.0) - y[1].abs() * y[1];
        rates[2] = (u - y[2]) * (T::from(1.0) + y[2].squared()).sqrt().times(8.0);
    }
    fn measurement<T: Scalar + From<f64>>(&self, y: &[T], _: &[T]) -> T {
        y[0].times(3.0)
    }
}

/// Precomputed matrices from sample to sample, or a method without them: one result, within the
/// tolerance.
#[test]
fn a_curved_plant_is_integrated_from_sample_to_sample() {
    let plant = CommandedPlant::on_hold(Bent, &TransferFunction::gain_only(1.0)).unwrap();
    for (sample_time_s, delay_s) in [(1e-3, 0.0), (1e-3, 0.4e-3), (0.02, 0.0), (0.02, 0.03)] {
        let reference = Profile::steps(1.0, &[(2.0, -2.0), (4.0, 5.0), (4.5013, 0.0)]).unwrap();
        let schedule = schedule(6.0, 0.5, vec![Input::Command, Input::Value(reference)]);
        let end_state = |method, tolerance| {
            let mut seen = Vec::new();
            let sampler = Box::new(Integrating { sample_time_s, delay_s, sum: 0.0, seen: &mut seen });
            let settings = settings(tolerance, method);
            let result =
                simulate(&plant, &[0.0; 3], &schedule, Some(sampler), &settings, &mut |_| true).unwrap();
            assert_eq!(result.outcome.status, Status::Completed);
            seen
        };
        let exact = end_state(Method::DormandPrince, 1e-11);
        for tolerance in [1e-4, 1e-6, 1e-8] {
            let seen = end_state(Method::Rosenbrock, tolerance);
            let pairs = seen.iter().zip(&exact);
            let error = pairs.map(|(one, other)| (one[1] - other[1]).abs()).fold(0.0, f64::max);
            assert!(error < 30.0 * tolerance, "{sample_time_s}, {delay_s}: {error} at {tolerance}");
        }
    }
}
