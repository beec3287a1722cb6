//! Indicators that change sign, compared with closed forms.

use std::f64::consts::PI;

use phea_dynamics::portable;
use phea_dynamics::scalar::Scalar;
use phea_dynamics::simulation::{Input, Method, Profile, System};

use super::laws::{run, run_by, schedule};

/// Oscillator x'' = -omega^2 x with an input w; the indicators are x - a for levels a, and w - 1/2.
#[derive(Clone)]
struct Watched {
    omega: f64,
    levels: Vec<f64>,
}

impl System<f64> for Watched {
    fn states(&self) -> usize {
        2
    }
    fn inputs(&self) -> usize {
        1
    }
    fn scales(&self) -> Vec<f64> {
        vec![1.0; 2]
    }
    fn rates<T: Scalar + From<f64>>(&self, y: &[T], _: &[T], rates: &mut [T]) {
        rates[0] = y[1].times(self.omega);
        rates[1] = y[0].times(-self.omega);
    }
    fn indicators(&self) -> usize {
        self.levels.len() + 1
    }
    fn indicate<T: Scalar + From<f64>>(&self, y: &[T], w: &[T], indicators: &mut [T]) {
        for (indicator, &level) in indicators.iter_mut().zip(&self.levels) {
            *indicator = y[0] - T::from(level);
        }
        indicators[self.levels.len()] = w[0] - T::from(0.5);
    }
}

fn still() -> Vec<Input> {
    vec![Input::Value(Profile::constant(0.0))]
}

/// x = sin(2 pi t) passes zero each half second, beginning exactly there.
#[test]
fn zeros_of_a_sine() {
    let system = Watched { omega: 2.0 * PI, levels: vec![0.0] };
    for method in [Method::Rosenbrock, Method::DormandPrince] {
        for tolerance in [1e-5, 1e-8, 1e-11] {
            let result = run_by(method, &system, &[0.0, 1.0], &schedule(10.2, 0.1, still()), tolerance);
            let events = &result.outcome.events;
            assert_eq!(events.len(), 21, "{events:?}");
            for (index, event) in events.iter().enumerate() {
                let error = (event.time_s - 0.5 * index as f64).abs();
                assert!(error < 1e3 * tolerance, "{event:?} at {tolerance}");
                assert_eq!((event.indicator, event.rising), (0, index % 2 == 0));
            }
        }
    }
}

/// Levels passed in one step are distinguished, in the order of time.
#[test]
fn several_in_one_step() {
    let levels = vec![0.5, -0.3, 0.1, 0.501, 0.0];
    let system = Watched { omega: 1.0, levels: levels.clone() };
    let result = run(&system, &[-1.0, 0.0], &schedule(3.0, 3.0, still()), 1e-9);
    let mut expected: Vec<(f64, usize)> = levels
        .iter()
        .enumerate()
        .map(|(index, &level)| {
            // -cos(t) = level, by halving
            let (mut low, mut high) = (0.0, PI);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                (low, high) = if -portable::cos(middle) < level { (middle, high) } else { (low, middle) };
            }
            (low, index)
        })
        .collect();
    expected.sort_by(|one, other| one.0.total_cmp(&other.0));
    assert_eq!(result.outcome.events.len(), expected.len());
    for (event, (time_s, index)) in result.outcome.events.iter().zip(expected) {
        assert!((event.time_s - time_s).abs() < 1e-7 && event.indicator == index && event.rising);
    }
}

/// An event from a break of an input is at the break; one between breaks is found between them.
#[test]
fn at_and_between_breaks() {
    let system = Watched { omega: 1.0, levels: vec![] };
    let ramp = Profile::smooth_step(1.3, 0.4, 1.0).unwrap();
    let steps = Profile::steps(0.0, &[(0.7, 1.0), (1.1, 0.0), (2.0, 1.0)]).unwrap();
    let result = run(&system, &[0.0, 1.0], &schedule(2.0, 0.5, vec![Input::Value(ramp)]), 1e-6);
    let [event] = result.outcome.events[..] else { panic!("{:?}", result.outcome.events) };
    assert!(event.rising && (event.time_s - 1.5).abs() < 1e-11, "{event:?}");
    let result = run(&system, &[0.0, 1.0], &schedule(2.0, 0.5, vec![Input::Value(steps)]), 1e-6);
    let times: Vec<(f64, bool)> = result.outcome.events.iter().map(|e| (e.time_s, e.rising)).collect();
    assert_eq!(times, [(0.7, true), (1.1, false)]);
}

/// No event is reported without a change of sign; an indicator that is positive from the start has
/// not become positive.
#[test]
fn nothing_happens() {
    let system = Watched { omega: 3.0, levels: vec![1.5, -1.5] };
    let result = run(&system, &[1.0, 0.0], &schedule(10.0, 1.0, still()), 1e-6);
    assert_eq!(result.outcome.events, []);
}
