//! The method restarts at breaks of the inputs: none is missed, none is smeared.

use phea_dynamics::portable;
use phea_dynamics::scalar::Scalar;
use phea_dynamics::simulation::{Input, Profile};

use super::laws::{Following, Integral, Law, Lawful, distance, last, run, schedule};

/// Equation y' = w - y.
#[derive(Clone)]
struct Lag;

impl Law for Lag {
    const STATES: usize = 1;
    const INPUTS: usize = 1;

    fn rates<T: Scalar>(&self, y: &[T], w: &[T], rates: &mut [T]) {
        rates[0] = w[0] - y[0];
    }
}

/// A hundred steps of a reference whose integral is known: exact at any tolerance, in one step from
/// break to break.
#[test]
fn steps_of_an_input_are_integrated_exactly() {
    let steps: Vec<(f64, f64)> =
        (1..100).map(|index| (0.0317 * f64::from(index), f64::from(index * index % 7) - 3.0)).collect();
    let area = |time_s: f64| {
        let ends = steps.iter().skip(1).map(|step| step.0).chain([f64::INFINITY]);
        let pieces = steps.iter().zip(ends);
        pieces.map(|(step, end)| step.1 * (time_s.min(end) - step.0).max(0.0)).sum::<f64>()
    };
    let inputs = vec![Input::Value(Profile::steps(0.0, &steps).unwrap())];
    let result = run(&Lawful(Integral, 1.0), &[0.0], &schedule(4.0, 0.01, inputs), 0.5);
    assert!(distance(&result, 0, area) < 1e-13);
    assert_eq!((result.outcome.work.steps, result.outcome.work.rejected), (100, 0));
}

/// Rows at a break show the inputs after it, and the state is continuous.
#[test]
fn the_response_to_a_step_begins_at_the_step() {
    for tolerance in [1e-4, 1e-7, 1e-10] {
        let inputs = vec![Input::Value(Profile::steps(0.0, &[(0.25, 1000.0), (0.5, -1000.0)]).unwrap())];
        let result = run(&Lawful(Lag, 1000.0), &[0.0], &schedule(1.0, 0.125, inputs), tolerance);
        let rise = |since: f64| 1000.0 * -portable::expm1(-since.max(0.0));
        let exact = |time_s: f64| rise(time_s - 0.25) - 2.0 * rise(time_s - 0.5);
        assert!(distance(&result, 0, exact) < 1000.0 * tolerance);
        let seen: Vec<f64> = result.trajectory.inputs.iter().map(|row| row[0]).collect();
        assert_eq!(seen, [0.0, 0.0, 1e3, 1e3, -1e3, -1e3, -1e3, -1e3, -1e3]);
        assert_eq!([0, 1, 2].map(|row| result.trajectory.states[row][0]), [0.0; 3]);
    }
}

/// A bump between two rows, ten thousand times shorter than the step before it.
#[test]
fn a_short_bump_is_not_stepped_over() {
    for (start_s, length_s) in [(4.5, 1e-6), (4.0, 1e-9), (1.0 / 3.0, 1e-4), (0.0, 1e-7), (9.0 + 1e-6, 1e-12)]
    {
        let end_s: f64 = start_s + length_s;
        let bump = Profile::steps(0.0, &[(start_s, 1.0 / length_s), (end_s, 0.0)]).unwrap();
        let result =
            run(&Lawful(Integral, 1.0), &[0.0], &schedule(10.0, 5.0, vec![Input::Value(bump)]), 1e-3);
        let area = (end_s - start_s) / length_s;
        assert!((last(&result, 0) - area).abs() < 1e-12, "{start_s} {}", last(&result, 0));
    }
}

/// Every kind of motion, begun at an arbitrary time: the integral of its velocity is the distance.
#[test]
fn motions_are_followed_from_their_start() {
    let motions = [
        Profile::smooth_step(7.0, 1e-5, 5e-3).unwrap(),
        Profile::smooth_step(7.3, 2.0, 5e-3).unwrap(),
        Profile::first_order(7.0, 1e-4, 5e-3).unwrap(),
        Profile::sine(7.0, 5e-3, 300.0).unwrap(),
        Profile::chirp(7.0, 1.0, 5e-3, [1.0, 400.0]).unwrap(),
        Profile::table(&[7.0, 7.0 + 1e-5, 7.0 + 3e-5, 8.0], &[0.0, 5e-3, 1e-3, 2e-3]).unwrap(),
    ];
    for motion in motions {
        let schedule = schedule(10.0, 0.1, vec![Input::Rate(motion.clone())]);
        let result = run(&Lawful(Integral, 5e-3), &[0.0], &schedule, 1e-9);
        let error = distance(&result, 0, |time_s| motion.value(time_s));
        assert!(error < 1e-9, "{error} {motion:?}");
        let bound = following_schedule(&motion);
        assert!(bound < 1e-9, "{bound} {motion:?}");
    }
}

fn following_schedule(motion: &Profile) -> f64 {
    let inputs = vec![Input::Value(motion.clone()), Input::Rate(motion.clone())];
    let result = run(&Lawful(Following(-20.0), 5e-3), &[0.0], &schedule(10.0, 0.1, inputs), 1e-9);
    distance(&result, 0, |time_s| motion.value(time_s))
}

/// Breaks at time zero, at the end, twice at one time, and as close as floating-point numbers
/// allow.
#[test]
fn breaks_may_coincide() {
    let sum = 0.1 + 0.2;
    let inputs = vec![
        Input::Value(Profile::steps(5.0, &[(0.0, 1.0), (0.3, 2.0), (1.0, 9.0)]).unwrap()),
        Input::Value(Profile::steps(0.0, &[(sum, 4.0), (0.6, 0.0), (2.0, 7.0)]).unwrap()),
    ];
    /// Equation y' = u + v.
    #[derive(Clone)]
    struct Both;
    impl Law for Both {
        const STATES: usize = 1;
        const INPUTS: usize = 2;
        fn rates<T: Scalar>(&self, _: &[T], w: &[T], rates: &mut [T]) {
            rates[0] = w[0] + w[1];
        }
    }
    let result = run(&Lawful(Both, 1.0), &[0.0], &schedule(1.0, 0.05, inputs), 1e-6);
    let exact = |t: f64| t + (t - 0.3).max(0.0) + 4.0 * ((t - 0.3).max(0.0) - (t - 0.6).max(0.0));
    assert!(distance(&result, 0, exact) < 1e-13);
    assert_eq!(result.trajectory.times_s.len(), 21);
    assert_eq!(result.trajectory.times_s.last(), Some(&1.0));
}
