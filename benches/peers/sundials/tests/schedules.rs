//! Comparison of phea's method and CVODE for equal equations, inputs and samples.

use phea_dynamics::scalar::Scalar;
use phea_dynamics::simulation::{
    Input, InputSchedule, Profile, Sampler, SimulationSettings, Status, System, simulate,
};
use sundials::{CvodeError, Following, Method, follow};

/// y'' = mu (1 - y^2) y' - y + w1 + c w2, with a load's motion w1 and its velocity w2, and a
/// command.
#[derive(Clone)]
struct Oscillator {
    mu: f64,
}

impl System<f64> for Oscillator {
    fn states(&self) -> usize {
        2
    }

    fn inputs(&self) -> usize {
        3
    }

    fn scales(&self) -> Vec<f64> {
        vec![1.0, 1.0 + self.mu]
    }

    fn rates<T: Scalar + From<f64>>(&self, state: &[T], inputs: &[T], rates: &mut [T]) {
        let damping = T::from(self.mu) * (T::from(1.0) - state[0] * state[0]);
        rates[0] = state[1];
        rates[1] = damping * state[1] - state[0] + inputs[0] + T::from(0.3) * inputs[1] + inputs[2];
    }
}

/// u = -k y, sampled and delayed.
struct Feedback {
    gain: f64,
    sample_time_s: f64,
    delay_s: f64,
}

impl Sampler for Feedback {
    fn sample_time_s(&self) -> f64 {
        self.sample_time_s
    }

    fn delay_s(&self) -> f64 {
        self.delay_s
    }

    fn command(&mut self, _time_s: f64, state: &[f64], _inputs: &[f64]) -> f64 {
        -self.gain * state[0]
    }
}

/// y' = u.
#[derive(Clone)]
struct Integrator;

impl System<f64> for Integrator {
    fn states(&self) -> usize {
        1
    }

    fn inputs(&self) -> usize {
        1
    }

    fn scales(&self) -> Vec<f64> {
        vec![1.0]
    }

    fn rates<T: Scalar + From<f64>>(&self, _state: &[T], inputs: &[T], rates: &mut [T]) {
        rates[0] = inputs[0];
    }
}

fn schedule(motion: &Profile, output_step_s: f64) -> InputSchedule {
    let inputs = vec![Input::Value(motion.clone()), Input::Rate(motion.clone()), Input::Command];
    InputSchedule { duration_s: 10.0, output_step_s, inputs }
}

#[test]
fn both_methods_agree_on_a_stiff_oscillator() {
    let motions = [
        Profile::smooth_step(1.0, 0.01, 2.0).unwrap(),
        Profile::first_order(1.0, 0.02, 2.0).unwrap(),
        Profile::sine(0.5, 1.0, 30.0).unwrap(),
    ];
    for motion in &motions {
        for mu in [0.1, 5.0, 100.0] {
            let (system, schedule) = (Oscillator { mu }, schedule(motion, 0.05));
            let settings = SimulationSettings { tolerance: 1e-10, ..SimulationSettings::default() };
            let ours = simulate(&system, &[1.5, 0.0], &schedule, None, &settings, &mut |_| true).unwrap();
            assert_eq!(ours.outcome.status, Status::Completed);
            let rows = follow(
                &system,
                &[1.5, 0.0],
                &schedule,
                None,
                &Following::new(1e-10, Method::BackwardDifferentiation),
            )
            .unwrap();
            assert_eq!(rows.len(), ours.trajectory.states.len());
            for (theirs, ours) in rows.iter().zip(&ours.trajectory.states) {
                assert!((theirs[0] - ours[0]).abs() < 1e-5, "mu {mu}: {theirs:?} {ours:?}");
            }
        }
    }
}

#[test]
fn samples_and_delayed_commands_have_equal_effects() {
    let motion = Profile::smooth_step(1.0, 0.1, 2.0).unwrap();
    // Rows that fall on samples, and rows that do not.
    for (output_step_s, delay_s) in [(0.05, 0.0), (0.05, 0.013), (0.07, 0.031)] {
        let (system, schedule) = (Oscillator { mu: 2.0 }, schedule(&motion, output_step_s));
        let mut feedback = Feedback { gain: 3.0, sample_time_s: 0.025, delay_s };
        let settings = SimulationSettings { tolerance: 1e-10, ..SimulationSettings::default() };
        let sampler = Box::new(Feedback { ..feedback });
        let ours =
            simulate(&system, &[1.5, 0.0], &schedule, Some(sampler), &settings, &mut |_| true).unwrap();
        let rows = follow(
            &system,
            &[1.5, 0.0],
            &schedule,
            Some(&mut feedback),
            &Following::new(1e-10, Method::Adams),
        )
        .unwrap();
        assert_eq!(rows.len(), ours.trajectory.states.len(), "{output_step_s}");
        for (theirs, ours) in rows.iter().zip(&ours.trajectory.states) {
            assert!((theirs[0] - ours[0]).abs() < 1e-6, "{delay_s}: {theirs:?} {ours:?}");
        }
    }
}

#[test]
fn a_sampled_integrator_shrinks_by_the_same_factor_each_sample() {
    let schedule = InputSchedule { duration_s: 2.0, output_step_s: 0.1, inputs: vec![Input::Command] };
    let mut feedback = Feedback { gain: 2.0, sample_time_s: 0.1, delay_s: 0.0 };
    let rows =
        follow(&Integrator, &[1.0], &schedule, Some(&mut feedback), &Following::new(1e-9, Method::Adams))
            .unwrap();
    assert_eq!(rows.len(), 21);
    let mut expected = 1.0;
    for row in rows {
        assert!((row[0] - expected).abs() < 1e-9, "{row:?} {expected}");
        expected *= 1.0 - 2.0 * 0.1;
    }
}

/// y' = -w, w = y one second ago.
#[derive(Clone)]
struct Late;

impl System<f64> for Late {
    fn states(&self) -> usize {
        1
    }

    fn inputs(&self) -> usize {
        1
    }

    fn scales(&self) -> Vec<f64> {
        vec![1.0]
    }

    fn rates<T: Scalar + From<f64>>(&self, _state: &[T], inputs: &[T], rates: &mut [T]) {
        rates[0] = -inputs[0];
    }

    fn delays(&self) -> Vec<f64> {
        vec![1.0]
    }

    fn outgoing<T: Scalar + From<f64>>(&self, state: &[T], _inputs: &[T], waves: &mut [T]) {
        waves[0] = state[0];
    }
}

#[test]
fn a_delayed_wave_arrives_as_it_was_sent() {
    let schedule = InputSchedule { duration_s: 4.0, output_step_s: 0.3, inputs: vec![] };
    let rows = follow(&Late, &[1.0, 1.0], &schedule, None, &Following::new(1e-11, Method::Adams)).unwrap();
    // y = sum over k of (-1)^k (t - k + 1)^k/k! from t = k - 1 on
    let exact = |t: f64| {
        let (mut sum, mut factorial) = (1.0, 1.0);
        for k in 1..=(t + 1.0) as i32 {
            factorial *= f64::from(k);
            sum += (-1.0_f64).powi(k) * (t - f64::from(k) + 1.0).max(0.0).powi(k) / factorial;
        }
        sum
    };
    assert_eq!(rows.len(), 14);
    for (index, row) in rows.iter().enumerate() {
        let expected = exact(0.3 * index as f64);
        assert!((row[0] - expected).abs() < 1e-9, "{index}: {row:?} {expected}");
    }
}

#[test]
fn waves_without_a_known_history_are_refused() {
    let schedule = InputSchedule { duration_s: 1.0, output_step_s: 0.1, inputs: vec![] };
    let answer = follow(&Late, &[1.0], &schedule, None, &Following::new(1e-6, Method::Adams));
    assert!(matches!(answer, Err(CvodeError::Argument(_))));
}
