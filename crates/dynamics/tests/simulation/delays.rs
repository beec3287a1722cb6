//! Delays: the method of steps in closed form, reflected waves, late commands.

use num_complex::Complex64;
use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::scalar::Scalar;
use phea_dynamics::simulation::{CommandedPlant, Input, Method, Profile, System};
use phea_dynamics::time_response::delayed_loop_step;

use super::closed_loop::Chain;
use super::laws::{distance, run, run_by, schedule};

/// Equation y'(t) = -k y(t - T).
#[derive(Clone)]
struct Late {
    gain: f64,
    delay_s: f64,
}

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
    fn rates<T: Scalar + From<f64>>(&self, _: &[T], w: &[T], rates: &mut [T]) {
        rates[0] = w[0].times(-self.gain);
    }
    fn delays(&self) -> Vec<f64> {
        vec![self.delay_s]
    }
    fn outgoing<T: Scalar + From<f64>>(&self, y: &[T], _: &[T], waves: &mut [T]) {
        waves[0] = y[0];
    }
}

/// Sum over j of (-k (t - (j-1) T))^j/j! up to j = t/T + 1, for y = 1 until time zero.
fn by_steps(gain: f64, delay_s: f64, time_s: f64) -> f64 {
    let (mut sum, mut power) = (0.0, 0_i32);
    while time_s >= f64::from(power - 1) * delay_s {
        let base = -gain * (time_s - f64::from(power - 1) * delay_s);
        sum += (1..=power).map(|factor| base / f64::from(factor)).product::<f64>();
        power += 1;
    }
    sum
}

/// Polynomials of degree one to four: no error but rounding, one step from break to break.
#[test]
fn a_late_integrator_is_a_polynomial_of_each_delay() {
    for (gain, delay_s) in [(1.0, 1.0), (0.7, 0.3), (3.0, 0.1)] {
        let late = Late { gain, delay_s };
        let schedule = schedule(4.0 * delay_s, 0.07 * delay_s, vec![]);
        for method in [Method::Rosenbrock, Method::DormandPrince] {
            let result = run_by(method, &late, &[1.0], &schedule, 1e-3);
            let error = distance(&result, 0, |time_s| by_steps(gain, delay_s, time_s));
            assert!(error < 1e-13, "{error}");
            assert_eq!(result.outcome.work.rejected, 0);
        }
    }
}

/// Limit of stability k T = pi/2, at which it oscillates for ever: y = cos(pi t/2) is the solution
/// of the history cos(pi t/2); with k T = 1 it decays.
#[test]
fn a_late_integrator_over_many_delays() {
    for tolerance in [1e-6, 1e-9] {
        let result = run(&Late { gain: 1.0, delay_s: 1.0 }, &[1.0], &schedule(12.0, 0.1, vec![]), tolerance);
        let error = distance(&result, 0, |time_s| by_steps(1.0, 1.0, time_s));
        assert!(error < 10.0 * tolerance, "{error} at {tolerance}");
    }
}

/// A wave between a source and an end; y is the integral of the wave that arrives at the end.
///
/// ```text
/// a = s + r b(t - T_b),    b = q a(t - T_a),    y' = a(t - T_a)
/// ```
#[derive(Clone)]
struct Reflected {
    near: f64,
    far: f64,
    delays_s: [f64; 2],
}

impl System<f64> for Reflected {
    fn states(&self) -> usize {
        1
    }
    fn inputs(&self) -> usize {
        3
    }
    fn scales(&self) -> Vec<f64> {
        vec![1.0]
    }
    fn rates<T: Scalar + From<f64>>(&self, _: &[T], w: &[T], rates: &mut [T]) {
        rates[0] = w[1];
    }
    fn delays(&self) -> Vec<f64> {
        self.delays_s.to_vec()
    }
    fn outgoing<T: Scalar + From<f64>>(&self, _: &[T], w: &[T], waves: &mut [T]) {
        waves[0] = w[0] + w[2].times(self.near);
        waves[1] = w[1].times(self.far);
    }
}

impl Reflected {
    /// Sum of the echoes of a source whose integral is known.
    fn integral(&self, source: impl Fn(f64) -> f64, time_s: f64) -> f64 {
        let (mut sum, mut factor) = (0.0, 1.0);
        let mut left = time_s - self.delays_s[0];
        while left >= 0.0 {
            sum += factor * source(left);
            factor *= self.near * self.far;
            left -= self.delays_s[0] + self.delays_s[1];
        }
        sum
    }
}

/// Steps of the source arrive as steps, after every reflection.
#[test]
fn steps_arrive_as_steps() {
    let source = Profile::steps(0.0, &[(1.0, 2.0), (1.25, -1.0)]).unwrap();
    let area = |t: f64| 2.0 * (t - 1.0).max(0.0) - 3.0 * (t - 1.25).max(0.0);
    for delays_s in [[0.5, 0.5], [0.3, 0.7], [0.2, 0.2]] {
        let once = Reflected { near: 0.0, far: -0.5, delays_s };
        let schedule_once = schedule(3.0, 0.01, vec![Input::Value(source.clone())]);
        let result = run(&once, &[0.0], &schedule_once, 1e-3);
        let error = distance(&result, 0, |time_s| once.integral(area, time_s));
        assert!(error < 1e-12 && result.outcome.work.rejected == 0, "{error} {:?}", result.outcome.work);
        let often = Reflected { near: 0.8, ..once };
        let result = run(&often, &[0.0], &schedule_once, 1e-8);
        let error = distance(&result, 0, |time_s| often.integral(area, time_s));
        assert!(error < 1e-7, "{delays_s:?}: {error} {:?}", result.outcome.work);
    }
}

/// A smooth signal stays smooth: the echoes of a quintic motion.
#[test]
fn motions_arrive_as_motions() {
    let motion = Profile::smooth_step(1.0, 0.4, 1.0).unwrap();
    for tolerance in [1e-6, 1e-9] {
        let line = Reflected { near: 0.9, far: -0.9, delays_s: [0.25, 0.15] };
        let inputs = vec![Input::Rate(motion.clone())];
        let result = run(&line, &[0.0], &schedule(4.0, 0.01, inputs), tolerance);
        let error = distance(&result, 0, |time_s| line.integral(|t| motion.value(t), time_s));
        assert!(error < 30.0 * tolerance, "{error} at {tolerance}");
    }
}

/// K e^(-s T)/s closed: polynomials again, from the step of the reference on.
#[test]
fn a_late_command_of_a_continuous_controller() {
    let controller = |delay_s| Controller {
        feedback: Compensator::new(vec![Element::Gain(2.0)]),
        timing: Timing { delay_s, ..Timing::default() },
        ..Controller::default()
    };
    let integrator = Chain::new(vec![0.0], 1.0);
    let delay_s = 0.3;
    let closed = CommandedPlant::in_loop(integrator.clone(), &controller(delay_s), 0.0).unwrap();
    let inputs = vec![Input::Value(Profile::steps(0.0, &[(0.5, 1.0)]).unwrap())];
    let result = run(&closed, &[0.0], &schedule(1.8, 0.01, inputs.clone()), 1e-6);
    // the error obeys e' = -2 e(t - T), e = 1 at the step and zero before: y moves one delay later
    let exact = |time_s: f64| {
        let since = time_s - 0.5 - delay_s;
        if since < 0.0 { 0.0 } else { 1.0 - by_steps(2.0, delay_s, since) }
    };
    assert!(distance(&result, 0, exact) < 1e-12, "{}", distance(&result, 0, exact));
    // equal to the linear result, with linear signals over short steps: second order in them; the
    // row may be one step late
    let path = TransferFunction::from_factors(2.0, vec![], vec![Complex64::new(0.0, 0.0)]).unwrap();
    let path = path.with_dead_time(delay_s).unwrap();
    let one = TransferFunction::gain_only(1.0);
    let (times, output) = delayed_loop_step(&path, &one, &one, 1.3, 26_000).unwrap();
    for (row, time) in result.trajectory.states.iter().zip(&result.trajectory.times_s) {
        let index = times.partition_point(|other| other + 0.5 < *time);
        if let Some(value) = output.get(index).filter(|_| *time >= 0.5) {
            assert!((row[0] - value).abs() < 1e-3, "{time}");
        }
    }
}

/// A plant of order three, a proportional-integral controller and a delay, compared with the linear
/// result.
#[test]
fn a_late_command_of_a_dynamic_controller() {
    let plant = Chain::new(vec![-2.0, -8.0, -20.0], 320.0);
    let integral = Element::ProportionalIntegral { proportional_gain: 0.6, integral_gain: 1.1 };
    let controller = Controller {
        feedback: Compensator::new(vec![integral]),
        prefilter: Compensator::new(vec![Element::RealPole { frequency: 5.0 }]),
        timing: Timing { delay_s: 0.05, ..Timing::default() },
        ..Controller::default()
    };
    let feedback = controller.feedback.transfer_function().unwrap();
    let path = plant.transfer_function().series(&feedback).unwrap().with_dead_time(0.05).unwrap();
    let prefilter = controller.prefilter.transfer_function().unwrap();
    let one = TransferFunction::gain_only(1.0);
    let closed = CommandedPlant::in_loop(plant, &controller, 0.0).unwrap();
    let inputs = vec![Input::Value(Profile::steps(0.0, &[(0.5, 1.0)]).unwrap())];
    let result = run(&closed, &[0.0; 5], &schedule(4.5, 0.05, inputs), 1e-9);
    // second order in the step: two step sizes, extrapolated
    let answer = |steps| delayed_loop_step(&path, &one, &prefilter, 4.0, steps).unwrap();
    let [coarse, fine] = [answer(8_000), answer(16_000)];
    assert_eq!((coarse.0[8_000], fine.0[16_000]), (4.0, 4.0));
    for row in 10..=90 {
        let at = row - 10;
        let exact = (4.0 * fine.1[200 * at] - coarse.1[100 * at]) / 3.0;
        let measured = result.trajectory.states[row][0];
        assert!((measured - exact).abs() < 1e-6, "{row}: {measured} {exact}");
    }
}
