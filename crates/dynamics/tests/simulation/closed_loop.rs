//! Continuous controllers: linear loops in closed form, limited loops compared with short equal
//! steps.

use num_complex::Complex64;
use phea_dynamics::controller::{AntiWindup, Compensator, Controller, Element};
use phea_dynamics::linear::{LinearError, TransferFunction};
use phea_dynamics::scalar::Scalar;
use phea_dynamics::simulation::{
    CommandedPlant, Input, Plant, Profile, Simulated, SimulationSettings, Status,
};
use phea_dynamics::time_response::{Interpolation, SampledSignal, forced_response};

use super::laws::{distance, run, schedule, simulate};

/// gain/((s - p_1)(s - p_2) ...): y_n' = p_n y_n + gain (u + d), y_k' = p_k y_k + y_(k+1); the
/// measurement is y_1. The load d is an input, which is fed forward.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Chain {
    poles: Vec<f64>,
    gain: f64,
}

impl Chain {
    pub(crate) fn new(poles: Vec<f64>, gain: f64) -> Chain {
        Chain { poles, gain }
    }

    pub(crate) fn transfer_function(&self) -> TransferFunction {
        let poles = self.poles.iter().map(|&pole| Complex64::new(pole, 0.0)).collect();
        TransferFunction::from_factors(self.gain, vec![], poles).unwrap()
    }
}

impl Plant<f64> for Chain {
    fn states(&self) -> usize {
        self.poles.len()
    }
    fn inputs(&self) -> usize {
        0
    }
    fn scales(&self) -> Vec<f64> {
        vec![1.0; self.poles.len()]
    }
    fn command_scale(&self) -> f64 {
        1.0
    }
    fn measurement_scale(&self) -> f64 {
        1.0
    }
    fn rates<T: Scalar + From<f64>>(&self, y: &[T], u: T, _: &[T], rates: &mut [T]) {
        let inputs = y.iter().skip(1).copied().chain([u.times(self.gain)]);
        for ((rate, pole), (own, input)) in rates.iter_mut().zip(&self.poles).zip(y.iter().zip(inputs)) {
            *rate = own.times(*pole) + input;
        }
    }
    fn measurement<T: Scalar + From<f64>>(&self, y: &[T], _: &[T]) -> T {
        y[0]
    }
}

/// Plant with a load at its input.
#[derive(Clone)]
struct Loaded(Chain);

impl Plant<f64> for Loaded {
    fn states(&self) -> usize {
        self.0.states()
    }
    fn inputs(&self) -> usize {
        1
    }
    fn scales(&self) -> Vec<f64> {
        self.0.scales()
    }
    fn command_scale(&self) -> f64 {
        1.0
    }
    fn measurement_scale(&self) -> f64 {
        1.0
    }
    fn rates<T: Scalar + From<f64>>(&self, y: &[T], u: T, w: &[T], rates: &mut [T]) {
        self.0.rates(y, u + w[0], &[], rates);
    }
    fn measurement<T: Scalar + From<f64>>(&self, y: &[T], _: &[T]) -> T {
        y[0]
    }
    fn disturbance<T: Scalar + From<f64>>(&self, _: &[T], w: &[T]) -> T {
        w[0]
    }
}

fn dynamic() -> Controller {
    let elements = vec![
        Element::ProportionalIntegral { proportional_gain: 2.0, integral_gain: 5.0 },
        Element::LeadLag { zero_frequency: 6.0, pole_frequency: 60.0 },
        Element::ComplexPoles { natural_frequency: 90.0, damping_ratio: 0.6 },
    ];
    let prefilter = Element::ComplexPoles { natural_frequency: 4.0, damping_ratio: 0.8 };
    Controller {
        feedback: Compensator::new(elements),
        prefilter: Compensator::new(vec![prefilter]),
        ..Controller::default()
    }
}

fn stepped(time_s: f64, height: f64) -> Input {
    Input::Value(Profile::steps(0.0, &[(time_s, height)]).unwrap())
}

fn answer(function: &TransferFunction, height: f64, after_s: f64, times: &[f64]) -> Vec<f64> {
    let step = SampledSignal::new(vec![after_s], vec![height], Interpolation::Hold).unwrap();
    forced_response(function, &step, times).unwrap()
}

#[test]
fn a_linear_loop_responds_as_its_transfer_function() {
    let (plant, controller) = (Chain::new(vec![-1.0, -3.0, -50.0], 100.0), dynamic());
    let feedback = controller.feedback.transfer_function().unwrap();
    let path = plant.transfer_function().series(&feedback).unwrap();
    let closed = path.feedback(&TransferFunction::gain_only(1.0)).unwrap();
    let whole = controller.prefilter.transfer_function().unwrap().series(&closed).unwrap();
    let system = CommandedPlant::in_loop(plant, &controller, 0.0).unwrap();
    let states = 3 + system.controller_states();
    let result = run(&system, &vec![0.0; states], &schedule(5.0, 0.02, vec![stepped(0.25, 3.0)]), 1e-11);
    let exact = answer(&whole, 3.0, 0.25, &result.trajectory.times_s);
    for (row, exact) in result.trajectory.states.iter().zip(&exact) {
        assert!((row[0] - exact).abs() < 1e-8, "{} {exact}", row[0]);
    }
    assert!(exact.iter().any(|value| *value > 2.9));
}

/// A load at the plant's input: P/(1 + L), and zero when it is fed forward.
#[test]
fn a_load_is_rejected_and_fed_forward() {
    let (chain, mut controller) = (Chain::new(vec![-1.0, -3.0], 10.0), dynamic());
    controller.prefilter = Compensator::default();
    let feedback = controller.feedback.transfer_function().unwrap();
    let disturbed = chain.transfer_function().feedback(&feedback).unwrap();
    for (feed_forward, part) in [(0.0, 1.0), (-1.0, 0.0), (-0.75, 0.25)] {
        let system = CommandedPlant::in_loop(Loaded(chain.clone()), &controller, feed_forward).unwrap();
        let states = 2 + system.controller_states();
        let inputs = vec![Input::Value(Profile::constant(0.0)), stepped(0.25, 2.0)];
        let result = run(&system, &vec![0.0; states], &schedule(3.0, 0.02, inputs), 1e-11);
        let exact = answer(&disturbed, 2.0 * part, 0.25, &result.trajectory.times_s);
        for (row, exact) in result.trajectory.states.iter().zip(&exact) {
            assert!((row[0] - exact).abs() < 1e-8, "{} {exact}", row[0]);
        }
    }
}

const PROPORTIONAL: f64 = 4.0;
const INTEGRAL: f64 = 8.0;
const LIMIT: f64 = 1.0;

fn limited(anti_windup: AntiWindup) -> Controller {
    let element = Element::ProportionalIntegral { proportional_gain: PROPORTIONAL, integral_gain: INTEGRAL };
    Controller {
        feedback: Compensator::new(vec![element]),
        command_limit: Some(LIMIT),
        anti_windup,
        ..Controller::default()
    }
}

fn saturating(anti_windup: AntiWindup, tolerance: f64) -> Simulated {
    let plant = Chain::new(vec![-0.5, -5.0], 5.0);
    let system = CommandedPlant::in_loop(plant, &limited(anti_windup), 0.0).unwrap();
    let inputs = vec![Input::Value(Profile::steps(0.0, &[(0.1, 1.5), (4.0, -0.5)]).unwrap())];
    let settings = SimulationSettings { tolerance, maximum_steps: 200_000, ..SimulationSettings::default() };
    let result =
        simulate(&system, &[0.0; 3], &schedule(8.0, 0.1, inputs), None, &settings, &mut |_| true).unwrap();
    assert_eq!(result.outcome.status, Status::Completed, "{anti_windup:?} {:?}", result.outcome.work);
    result
}

/// Output y_1 by 10^5 equal steps a second of the midpoint rule, with the integral i as an explicit
/// sum.
///
/// ```text
/// wanted = K_p e + i,    i' = K_i e                          none
/// i' = K_i (e + (u - wanted)/K_p)                            back calculation
/// i' = 0 if |wanted| > limit and wanted e > 0              clamping
/// ```
fn by_short_steps(anti_windup: AntiWindup) -> Vec<f64> {
    let step = 1e-5;
    let rates = |[position, rate, integral]: [f64; 3], reference: f64| {
        let error = reference - position;
        let wanted = PROPORTIONAL * error + integral;
        let command = wanted.clamp(-LIMIT, LIMIT);
        let driven = match anti_windup {
            AntiWindup::None => error,
            AntiWindup::BackCalculation => error + (command - wanted) / PROPORTIONAL,
            AntiWindup::Clamping if command != wanted && wanted * error > 0.0 => 0.0,
            AntiWindup::Clamping => error,
        };
        [-0.5 * position + rate, -5.0 * rate + 5.0 * command, INTEGRAL * driven]
    };
    let mut state = [0.0; 3];
    let mut rows = vec![0.0];
    for index in 0..800_000 {
        let reference = if index < 10_000 {
            0.0
        } else if index < 400_000 {
            1.5
        } else {
            -0.5
        };
        let first = rates(state, reference);
        let middle = [0, 1, 2].map(|place| state[place] + 0.5 * step * first[place]);
        let second = rates(middle, reference);
        state = [0, 1, 2].map(|place| state[place] + step * second[place]);
        if (index + 1) % 10_000 == 0 {
            rows.push(state[0]);
        }
    }
    rows
}

#[test]
fn a_limited_loop_winds_up_only_without_anti_windup() {
    let mut greatest = Vec::new();
    for anti_windup in [AntiWindup::None, AntiWindup::BackCalculation, AntiWindup::Clamping] {
        let exact = by_short_steps(anti_windup);
        let result = saturating(anti_windup, 1e-7);
        assert_eq!(result.trajectory.states.len(), exact.len());
        for (row, exact) in result.trajectory.states.iter().zip(&exact) {
            assert!((row[0] - exact).abs() < 2e-4, "{anti_windup:?}: {} {exact}", row[0]);
        }
        assert!(result.outcome.work.steps < 3_000, "{anti_windup:?}: {:?}", result.outcome.work);
        greatest.push(exact.iter().fold(0.0_f64, |most, value| most.max(*value)));
    }
    // 1.5 is the command before the limit
    assert!(greatest[0] > greatest[2] && greatest[0] > greatest[1], "{greatest:?}");
}

/// The limited command is never above its limit, and the indicator of the limit shows when it is
/// active.
#[test]
fn the_limit_is_satisfied_and_reported() {
    let result = saturating(AntiWindup::BackCalculation, 1e-8);
    let events = &result.outcome.events;
    assert!(events.first().is_some_and(|event| event.rising && (event.time_s - 0.1).abs() < 1e-9));
    assert!(events.windows(2).all(|pair| pair[0].rising != pair[1].rising));
    let plant = Chain::new(vec![-0.5, -5.0], 5.0);
    let system = CommandedPlant::in_loop(plant, &limited(AntiWindup::BackCalculation), 0.0).unwrap();
    for (time, (state, inputs)) in
        result.trajectory.times_s.iter().zip(result.trajectory.states.iter().zip(&result.trajectory.inputs))
    {
        let signals = system.signals::<f64, f64>(state, inputs);
        assert!(signals.command.abs() <= LIMIT);
        let binds = events.iter().take_while(|event| event.time_s <= *time).last().is_some_and(|e| e.rising);
        assert_eq!(signals.wanted.abs() > LIMIT, binds, "{time} {signals:?} {events:?}");
    }
}

#[test]
fn a_controller_without_a_continuous_form_is_refused() {
    let plant = Chain::new(vec![-1.0], 1.0);
    let improper =
        Controller { feedback: Compensator::new(vec![Element::Differentiator]), ..Controller::default() };
    assert!(matches!(
        CommandedPlant::in_loop(plant.clone(), &improper, 0.0),
        Err(LinearError::Improper { .. })
    ));
    let slow = Controller {
        feedback: Compensator::new(vec![Element::RealPole { frequency: 3.0 }]),
        anti_windup: AntiWindup::BackCalculation,
        ..Controller::default()
    };
    assert_eq!(CommandedPlant::in_loop(plant, &slow, 0.0), Err(LinearError::NoFeedthrough));
}

/// A loop at rest without error stays at rest, in few steps.
#[test]
fn a_loop_at_rest_stays_there() {
    let system = CommandedPlant::in_loop(Chain::new(vec![-1.0, -3.0], 1.0), &dynamic(), 0.0).unwrap();
    let states = 2 + system.controller_states();
    let inputs = vec![Input::Value(Profile::constant(0.0))];
    let result = run(&system, &vec![0.0; states], &schedule(100.0, 10.0, inputs), 1e-9);
    assert!(distance(&result, 0, |_| 0.0) == 0.0 && result.outcome.work.steps < 10);
}
