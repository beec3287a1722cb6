//! Orders of convergence at the ends of steps and between them.

use std::f64::consts::PI;

use phea_dynamics::portable;
use phea_dynamics::simulation::{Input, Method, Profile, Simulated};

use super::laws::{Lawful, Oscillator, Reciprocal, distance, run_by, schedule};

const METHODS: [Method; 2] = [Method::Rosenbrock, Method::DormandPrince];

/// y = 1/(2 + sin(2 t)), with `steps` equal steps in 3 s: an unused input breaks there, and a scale
/// of 1e12 removes the effect of the error.
fn by_equal_steps(method: Method, steps: u32, rows: f64) -> Simulated {
    let breaks: Vec<(f64, f64)> =
        (1..steps).map(|step| (3.0 * f64::from(step) / f64::from(steps), f64::from(step % 2))).collect();
    let sine = Profile::sine(0.0, 1.0, 2.0).unwrap();
    let inputs = vec![Input::Rate(sine), Input::Value(Profile::steps(0.0, &breaks).unwrap())];
    let result = run_by(method, &Lawful(Reciprocal, 1e12), &[0.5], &schedule(3.0, rows, inputs), 0.5);
    assert_eq!((result.outcome.work.steps, result.outcome.work.rejected), (u64::from(steps), 0));
    result
}

fn exact(time_s: f64) -> f64 {
    1.0 / (2.0 + portable::sin(2.0 * time_s))
}

#[test]
fn halving_the_step_leaves_a_thirty_second_of_the_error() {
    for method in METHODS {
        let errors = [32, 64, 128, 256].map(|steps| distance(&by_equal_steps(method, steps, 3.0), 0, exact));
        for pair in errors.windows(2) {
            let order = portable::ln(pair[0] / pair[1]) / portable::ln(2.0);
            assert!(order > 4.5 && order < 6.5, "{method:?}: {errors:?}");
        }
        assert!(errors[3] < 1e-9, "{method:?}: {errors:?}");
    }
}

/// Rows at 0.07, 0.14 ... of the duration are anywhere in the steps.
#[test]
fn rows_between_steps_are_of_order_four_at_least() {
    for method in METHODS {
        let errors = [16, 32, 64, 128].map(|steps| distance(&by_equal_steps(method, steps, 0.007), 0, exact));
        for pair in errors.windows(2) {
            let order = portable::ln(pair[0] / pair[1]) / portable::ln(2.0);
            assert!(order > 4.0, "{method:?}: {errors:?}");
        }
        assert!(errors[3] < 1e-7, "{method:?}: {errors:?}");
    }
}

#[test]
fn the_error_follows_the_tolerance_and_the_work_its_fifth_root() {
    let oscillator = Lawful(Oscillator(2.0 * PI), 1.0);
    for method in METHODS {
        let measured = [1e-4, 1e-6, 1e-8, 1e-10].map(|tolerance| {
            let result = run_by(method, &oscillator, &[1.0, 0.0], &schedule(10.0, 0.1, vec![]), tolerance);
            let error = distance(&result, 0, |time_s| portable::cos(2.0 * PI * time_s));
            assert!(error < 1e3 * tolerance, "{method:?}: {error} at {tolerance}");
            (error, result.outcome.work.steps as f64)
        });
        let [coarse, .., fine] = measured;
        let slope = portable::ln(coarse.0 / fine.0) / portable::ln(fine.1 / coarse.1);
        assert!(slope > 4.5 && slope < 6.0, "{method:?}: {measured:?}");
    }
}

/// The invariant of x'' = -x drifts no faster than the tolerance allows.
#[test]
fn the_energy_of_an_oscillator_is_conserved() {
    for method in METHODS {
        let result =
            run_by(method, &Lawful(Oscillator(1.0), 1.0), &[0.6, 0.8], &schedule(200.0, 1.0, vec![]), 1e-10);
        for row in &result.trajectory.states {
            assert!((row[0] * row[0] + row[1] * row[1] - 1.0).abs() < 1e-7);
        }
        assert_eq!(result.trajectory.times_s.len(), 201);
    }
}
