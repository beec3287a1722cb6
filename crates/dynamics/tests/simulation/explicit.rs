//! Two independent methods give one result.

use phea_dynamics::scalar::Scalar;
use phea_dynamics::simulation::{Input, Method, Profile, SimulationSettings, Status};

use super::laws::{Law, Lawful, run_by, schedule, settings, simulate};

/// A pendulum whose support is shaken: theta'' = -(9.81 + w) sin(theta) - theta'/10, sin by its
/// series.
#[derive(Clone)]
struct Pendulum;

impl Law for Pendulum {
    const STATES: usize = 2;
    const INPUTS: usize = 1;

    fn rates<T: Scalar>(&self, y: &[T], w: &[T], rates: &mut [T]) {
        let square = y[0].squared();
        let series = [1.0 / 6.0, 1.0 / 20.0, 1.0 / 42.0, 1.0 / 72.0, 1.0 / 110.0];
        let one = T::from(1.0);
        let sine = y[0] * series.iter().rev().fold(one, |sum, &part| one - square.times(part) * sum);
        rates[0] = y[1];
        rates[1] = -(T::from(9.81) + w[0]) * sine - y[1].times(0.1);
    }
}

#[test]
fn both_methods_agree_on_a_mild_system() {
    let shaken = Profile::table(&[0.0, 1.0, 2.5, 4.0, 5.0], &[0.0, 3.0, -4.0, 2.0, 0.0]).unwrap();
    let schedule = schedule(10.0, 0.03, vec![Input::Value(shaken)]);
    for tolerance in [1e-5, 1e-7, 1e-9] {
        let [implicit, explicit] = [Method::Rosenbrock, Method::DormandPrince]
            .map(|method| run_by(method, &Lawful(Pendulum, 1.0), &[1.5, 0.0], &schedule, tolerance));
        assert_eq!(implicit.trajectory.times_s, explicit.trajectory.times_s);
        let rows = implicit.trajectory.states.iter().zip(&explicit.trajectory.states);
        for (one, other) in rows {
            assert!((one[0] - other[0]).abs() < 100.0 * tolerance, "{one:?} {other:?} at {tolerance}");
            assert!((one[1] - other[1]).abs() < 300.0 * tolerance, "{one:?} {other:?} at {tolerance}");
        }
        assert!(implicit.outcome.end != explicit.outcome.end);
    }
}

/// Equation y' = -1e7 y: stability bounds the step of the explicit method, but not of the implicit
/// one.
#[test]
fn an_explicit_method_pays_for_a_fast_mode() {
    let stiff = Lawful(super::laws::Following(-1e7), 1.0);
    let inputs = || vec![Input::Value(Profile::constant(0.0)), Input::Value(Profile::constant(0.0))];
    let schedule = schedule(1.0, 1.0, inputs());
    let limited = SimulationSettings { maximum_steps: 1000, ..settings(1e-6, Method::DormandPrince) };
    let explicit = simulate(&stiff, &[1.0], &schedule, None, &limited, &mut |_| true).unwrap();
    assert!(matches!(explicit.outcome.status, Status::TooManySteps { time_s } if time_s < 1e-3));
    let limited = SimulationSettings { method: Method::Rosenbrock, ..limited };
    let implicit = simulate(&stiff, &[1.0], &schedule, None, &limited, &mut |_| true).unwrap();
    assert_eq!(implicit.outcome.status, Status::Completed);
}
