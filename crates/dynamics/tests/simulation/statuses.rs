//! End statuses of simulations, and rejected inputs.

use phea_dynamics::scalar::Scalar;
use phea_dynamics::simulation::{
    Input, InputSchedule, Profile, Sampler, Simulated, SimulationError, SimulationNumber, SimulationSettings,
    Status, System,
};

use super::laws::{Integral, Law, Lawful, Oscillator, schedule, simulate};

/// Equation y' = y^2, with solution y = 1/(1 - t).
#[derive(Clone)]
struct Blow;

impl Law for Blow {
    const STATES: usize = 1;

    fn rates<T: Scalar>(&self, y: &[T], _: &[T], rates: &mut [T]) {
        rates[0] = y[0].squared();
    }
}

/// Equation y' = -sqrt(y), with solution y = (1 - t/2)^2, at rest from t = 2 on; NaN if it becomes
/// negative.
#[derive(Clone)]
struct Draining;

impl Law for Draining {
    const STATES: usize = 1;

    fn rates<T: Scalar>(&self, y: &[T], _: &[T], rates: &mut [T]) {
        rates[0] = -y[0].sqrt() - T::from(0.1);
    }
}

/// Equation y' = 1000 y.
#[derive(Clone)]
struct Growing;

impl Law for Growing {
    const STATES: usize = 1;

    fn rates<T: Scalar>(&self, y: &[T], _: &[T], rates: &mut [T]) {
        rates[0] = y[0].times(1e3);
    }
}

/// Equation y' = -sign(y), on which no step can end.
#[derive(Clone)]
struct Chattering;

impl Law for Chattering {
    const STATES: usize = 1;

    fn rates<T: Scalar>(&self, y: &[T], _: &[T], rates: &mut [T]) {
        rates[0] = T::select(y[0].less_than(T::from(0.0)), T::from(1.0), T::from(-1.0));
    }
}

fn driven<E: System<f64> + Clone>(
    system: &E,
    start: &[f64],
    schedule: &InputSchedule,
    steps: u64,
) -> Simulated {
    let settings = SimulationSettings { maximum_steps: steps, ..SimulationSettings::default() };
    let result = simulate(system, start, schedule, None, &settings, &mut |_| true).unwrap();
    let end = match result.outcome.status {
        Status::Completed => schedule.duration_s,
        Status::Cancelled { time_s }
        | Status::StepTooSmall { time_s }
        | Status::NotFinite { time_s }
        | Status::UnresolvedOscillation { time_s, .. }
        | Status::TooManySteps { time_s } => time_s,
    };
    assert!(result.outcome.work.steps + result.outcome.work.rejected <= steps);
    assert!(result.outcome.end.iter().all(|value| value.is_finite()), "{:?}", result.outcome);
    for (time, row) in result.trajectory.times_s.iter().zip(&result.trajectory.states) {
        assert!(*time <= end && row.iter().all(|value| value.is_finite()), "{time} {row:?}, end {end}");
    }
    result
}

#[test]
fn the_time_at_which_a_solution_ends_is_reported() {
    let result = driven(&Lawful(Blow, 1.0), &[1.0], &schedule(2.0, 1e-3, vec![]), 100_000);
    let (Status::StepTooSmall { time_s } | Status::NotFinite { time_s }) = result.outcome.status else {
        panic!("{:?}", result.outcome);
    };
    assert!((time_s - 1.0).abs() < 1e-5, "{time_s}");
    assert!(result.outcome.work.steps < 20_000, "{:?}", result.outcome.work);
}

#[test]
fn the_time_of_a_root_of_a_negative_number_is_reported() {
    let result = driven(&Lawful(Draining, 1.0), &[1.0], &schedule(5.0, 1e-2, vec![]), 100_000);
    let Status::NotFinite { time_s } = result.outcome.status else { panic!("{:?}", result.outcome) };
    // dt = -dy/(sqrt(y) + 0.1): 2 - 0.2 ln(11)
    let exact = 2.0 - 0.2 * phea_dynamics::portable::ln(11.0);
    assert!((time_s - exact).abs() < 1e-3, "{time_s} {exact}");
}

#[test]
fn an_overflowing_state_yields_no_row() {
    let result = driven(&Lawful(Growing, 1.0), &[1.0], &schedule(2.0, 1e-4, vec![]), 1_000_000);
    let (Status::StepTooSmall { time_s } | Status::NotFinite { time_s }) = result.outcome.status else {
        panic!("{:?}", result.outcome);
    };
    // 1000 t = ln(1.8e308)
    assert!((time_s - 0.7097).abs() < 0.02, "{time_s}"); // ORIGIN: analytic
}

#[test]
fn work_is_bounded() {
    for steps in [1, 7, 1000] {
        let result = driven(&Lawful(Chattering, 1.0), &[0.5], &schedule(1e6, 1.0, vec![]), steps);
        assert!(matches!(result.outcome.status, Status::TooManySteps { .. } | Status::StepTooSmall { .. }));
        let smooth = driven(&Lawful(Oscillator(1.0), 1.0), &[1.0, 0.0], &schedule(1e6, 1.0, vec![]), steps);
        assert!(matches!(smooth.outcome.status, Status::TooManySteps { time_s } if time_s < 1e4));
        assert_eq!(smooth.outcome.work.steps + smooth.outcome.work.rejected, steps);
    }
}

/// The watch receives the time of each step and stops at the first that is late enough; the rows
/// before are retained.
#[test]
fn a_simulation_can_be_stopped() {
    let system = Lawful(Oscillator(1.0), 1.0);
    let schedule = schedule(100.0, 0.5, vec![]);
    let mut times_s = Vec::new();
    let mut watch = |time_s: f64| {
        times_s.push(time_s);
        time_s < 30.0
    };
    let result =
        simulate(&system, &[1.0, 0.0], &schedule, None, &SimulationSettings::default(), &mut watch).unwrap();
    let Status::Cancelled { time_s } = result.outcome.status else { panic!("{:?}", result.outcome) };
    assert!((30.0..33.0).contains(&time_s) && times_s.last() == Some(&time_s));
    assert!(times_s.windows(2).all(|pair| pair[0] <= pair[1]));
    assert_eq!(result.trajectory.times_s.len(), (time_s / 0.5).ceil() as usize);
}

struct FixedSampler(f64, f64, f64);

impl Sampler for FixedSampler {
    fn sample_time_s(&self) -> f64 {
        self.0
    }
    fn delay_s(&self) -> f64 {
        self.1
    }
    fn command(&mut self, time_s: f64, _: &[f64], _: &[f64]) -> f64 {
        if time_s > 0.45 { self.2 } else { 1.0 }
    }
}

#[test]
fn a_command_that_is_no_number_ends_it() {
    for delay_s in [0.0, 0.05, 0.3] {
        for command in [f64::NAN, f64::INFINITY] {
            let sampler = Box::new(FixedSampler(0.1, delay_s, command));
            let schedule = schedule(1.0, 0.01, vec![Input::Command]);
            let system = Lawful(Integral, 1.0);
            let settings = SimulationSettings::default();
            let result =
                simulate(&system, &[0.0], &schedule, Some(sampler), &settings, &mut |_| true).unwrap();
            assert_eq!(result.outcome.status, Status::NotFinite { time_s: 0.5 });
            assert!(result.trajectory.states.iter().all(|row| row[0].is_finite()));
            assert!((result.outcome.end[0] - (0.5 - delay_s)).abs() < 1e-12);
        }
    }
}

#[track_caller]
fn refused(
    start: &[f64],
    schedule: &InputSchedule,
    sampler: Option<FixedSampler>,
    tolerance: f64,
) -> SimulationError {
    let settings = SimulationSettings { tolerance, ..SimulationSettings::default() };
    let sampler = sampler.map(|sampler| Box::new(sampler) as Box<dyn Sampler>);
    simulate(&Lawful(Integral, 1.0), start, schedule, sampler, &settings, &mut |_| true).unwrap_err()
}

#[test]
fn mismatched_arguments_are_refused() {
    let good = schedule(1.0, 0.1, vec![Input::Value(Profile::constant(1.0))]);
    let setting = |error| match error {
        SimulationError::Setting { what, .. } => what,
        other => panic!("{other:?}"),
    };
    for tolerance in [0.0, -1e-6, 1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(setting(refused(&[0.0], &good, None, tolerance)), SimulationNumber::Tolerance);
    }
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let with = |duration_s, output_step_s| InputSchedule { duration_s, output_step_s, ..good.clone() };
        assert_eq!(setting(refused(&[0.0], &with(bad, 0.1), None, 1e-6)), SimulationNumber::Duration);
        assert_eq!(setting(refused(&[0.0], &with(1.0, bad), None, 1e-6)), SimulationNumber::OutputStep);
        assert_eq!(
            setting(refused(&[0.0], &good, Some(FixedSampler(bad, 0.0, 1.0)), 1e-6)),
            SimulationNumber::SampleTime
        );
    }
    for bad in [-1e-9, f64::NAN, f64::INFINITY] {
        let sampler = Some(FixedSampler(0.1, bad, 1.0));
        assert_eq!(setting(refused(&[0.0], &good, sampler, 1e-6)), SimulationNumber::CommandDelay);
    }
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(matches!(refused(&[bad], &good, None, 1e-6), SimulationError::Start { index: 0, .. }));
    }
    let counted = |error| matches!(error, SimulationError::Count { .. });
    assert!(counted(refused(&[0.0, 1.0], &good, None, 1e-6)) && counted(refused(&[], &good, None, 1e-6)));
    let inputs = vec![Input::Command; 2];
    assert!(counted(refused(&[0.0], &InputSchedule { inputs, ..good.clone() }, None, 1e-6)));
    assert!(counted(refused(&[0.0], &InputSchedule { inputs: vec![], ..good }, None, 1e-6)));
}

/// An invalid magnitude would make every error infinite or zero.
#[test]
fn a_scale_that_is_no_magnitude_is_refused() {
    for scale in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let system = Lawful(Oscillator(1.0), scale);
        let settings = SimulationSettings::default();
        let result =
            simulate(&system, &[1.0, 0.0], &schedule(1.0, 1.0, vec![]), None, &settings, &mut |_| true);
        assert!(matches!(result, Err(SimulationError::Setting { .. })), "{scale}: {result:?}");
    }
}

/// Time only advances in a system without states.
#[test]
fn a_system_without_states_arrives() {
    #[derive(Clone)]
    struct Nothing;
    impl Law for Nothing {
        const STATES: usize = 0;
        fn rates<T: Scalar>(&self, _: &[T], _: &[T], _: &mut [T]) {}
    }
    let result = driven(&Lawful(Nothing, 1.0), &[], &schedule(1.0, 0.25, vec![]), 100);
    assert_eq!((result.outcome.status, result.trajectory.times_s.len()), (Status::Completed, 5));
}
