//! Unit step of the reference through prefilter and closed loop, for one plant: continuous or
//! sampled, with dead time or without, known by polynomials or by its response.

mod of_responses;

use std::f64::consts::PI;

use phea_dynamics::linear::{LinearError, TransferFunction};
use phea_dynamics::time_response::{
    TimeResponseError, delayed_loop_step, sampled_loop_step, step_of_frequency_response, step_response,
    uniform_times, weights_of_frequency_response,
};
use phea_qft::closed_loop::{Compensation, Member};

pub(crate) use of_responses::KnownResponses;
use of_responses::{ClosedParts, parts_of_change, real_parts};

/// A step response from the step on: fraction of the step as a function of time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepResponse {
    /// Times, s.
    pub times_s: Vec<f64>,
    /// Values: 0 before the step, 1 at the new reference.
    pub values: Vec<f64>,
}

/// Signal of the response to a step of the reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum StepSignal {
    /// Output of the plant.
    Output,
    /// Command of the controller, in its unit for each unit of the reference.
    Command,
}

/// Lowest frequency at which a change of the loop matters, multiplied by the time.
const LOWEST: f64 = 0.01;
/// Largest number of samples of a sampled response.
const SAMPLES_MAXIMUM: usize = 100_000;

/// Response over this time, with about this many points for a continuous loop; a sampled loop has
/// its samples.
///
/// # Errors
/// [`LinearError::NoPlant`] for a measured plant, which is unknown beyond its frequencies, and
/// [`TimeResponseError`] for a system that cannot be realised.
pub fn linear_step(
    member: &Member,
    compensation: &Compensation,
    duration_s: f64,
    points: usize,
) -> Result<StepResponse, TimeResponseError> {
    let known = KnownResponses::default();
    linear_step_knowing(member, StepSignal::Output, compensation, duration_s, points, &known)
}

/// Command of the controller in such a step, in its unit for each unit of the reference: the step
/// response of F G/(1 + L). The feedback of an inner signal is part of the plant.
///
/// # Errors
/// The errors of [`linear_step`].
pub fn linear_command_step(
    member: &Member,
    compensation: &Compensation,
    duration_s: f64,
    points: usize,
) -> Result<StepResponse, TimeResponseError> {
    let known = KnownResponses::default();
    linear_step_knowing(member, StepSignal::Command, compensation, duration_s, points, &known)
}

/// Step response of a signal of the loop, with the known responses of this plant in a loop of equal
/// timing and sensor.
pub(crate) fn linear_step_knowing(
    member: &Member,
    signal: StepSignal,
    compensation: &Compensation,
    duration_s: f64,
    points: usize,
    known: &KnownResponses,
) -> Result<StepResponse, TimeResponseError> {
    let prefilter = compensation.prefilter_of_step()?;
    let feedback = compensation.feedback();
    let samples =
        |sample_time_s: f64| ((duration_s / sample_time_s).ceil() as usize + 1).clamp(10, SAMPLES_MAXIMUM);
    let (times_s, values) = match member {
        Member::Continuous { plant, sensor, .. } => {
            let path = plant.command.transfer_function()?.with_dead_time(plant.dead_time_s)?;
            let (forward, back) = match signal {
                StepSignal::Output => (path.series(feedback)?, sensor.clone()),
                StepSignal::Command => (feedback.clone(), path.series(sensor)?),
            };
            if forward.dead_time_s() + back.dead_time_s() > 0.0 {
                delayed_loop_step(&forward, &back, &prefilter, duration_s, points)?
            } else {
                let closed = prefilter.series(&forward.feedback(&back)?)?;
                let times_s = uniform_times(duration_s, points + 1)?;
                let values = step_response(&closed, &times_s)?;
                (times_s, values)
            }
        }
        Member::Sampled { command, with_sensor, .. } => {
            let count = samples(compensation.sample_time_s().unwrap_or(duration_s));
            let behind = match signal {
                StepSignal::Output => command.clone(),
                StepSignal::Command => TransferFunction::gain_only(1.0).in_domain(command.domain())?,
            };
            sampled_loop_step(&behind, with_sensor, feedback, &prefilter, count)?
        }
        Member::Responding { plant, .. } => {
            let sample_time_s = compensation.sample_time_s();
            let step_s = sample_time_s.unwrap_or(duration_s / points as f64);
            let ClosedParts { parts, scale, at_once } = real_parts(plant, signal, compensation, known)?;
            let count = samples(step_s);
            let values = step_of_frequency_response(&parts, step_s, count, sample_time_s.is_some());
            let values = values.into_iter().map(|value| at_once + scale * value).collect();
            ((0..count).map(|sample| sample as f64 * step_s).collect(), values)
        }
        Member::Measured { .. } => return Err(LinearError::NoPlant.into()),
    };
    Ok(StepResponse { times_s, values })
}

/// Transfer of a disturbance from the loop of one controller to that of another around one plant:
/// samples of the response of either loop to it, by a convolution.
///
/// ```text
/// y'(k) = y(k) + sum of g(i) y(k - i),     g that of (1 + L)/(1 + L') - 1
/// ```
pub(crate) struct CarriedDisturbance {
    weights: Vec<f64>,
}

impl CarriedDisturbance {
    /// Transfer from the loop of one controller to that of another, for this many samples at this
    /// distance.
    pub(crate) fn new(
        member: &Member,
        loops: [&Compensation; 2],
        step_s: f64,
        count: usize,
        known: &KnownResponses,
    ) -> CarriedDisturbance {
        let range = [LOWEST / (count as f64 * step_s), PI / step_s];
        let parts = parts_of_change(member, loops, range, known);
        CarriedDisturbance { weights: weights_of_frequency_response(&parts, step_s, count) }
    }

    /// Samples with the other controller.
    pub(crate) fn of(&self, samples: &[f64]) -> Vec<f64> {
        let mut carried = samples.to_vec();
        for (delay, weight) in self.weights.iter().enumerate().take(samples.len()) {
            for (sum, value) in carried[delay..].iter_mut().zip(samples) {
                *sum += weight * value;
            }
        }
        carried
    }
}

#[cfg(test)]
mod tests {
    use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
    use phea_dynamics::portable::exp;
    use phea_dynamics::uncertain_plant::PlantCoefficients;
    use phea_dynamics::uncertain_plant::RationalCoefficients;

    use super::*;

    /// An integrator after a gain, disturbed at its output such that its response has two decays.
    #[test]
    fn a_disturbance_is_carried_from_one_controller_to_another() {
        const STEP_S: f64 = 1e-3;
        const COUNT: usize = 400;
        const OTHER: f64 = 60.0;
        for sample_time_s in [None, Some(STEP_S)] {
            let around = |gain: f64| {
                let feedback = Compensator::new(vec![Element::Gain(gain)]);
                let timing = Timing { sample_time_s, ..Timing::default() };
                let controller = Controller { feedback, timing, ..Controller::default() };
                Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap()
            };
            let command = RationalCoefficients { numerator: vec![1.0], denominator: vec![1.0, 0.0] };
            let plant = PlantCoefficients { command, disturbance: None, dead_time_s: 0.0, rate: None };
            for [before, after] in [[10.0, 25.0], [25.0, 10.0]] {
                let loops = [around(before), around(after)];
                let member = loops[0].member(plant.clone()).unwrap();
                // ORIGIN: analytic, of e^(-k t) - e^(-c t) becomes e^(-k' t) - e^(-c t) times
                // (c - k)/(c - k'); sampled with 1 - k h in place of e^(-k h)
                let decay = |rate: f64| {
                    if sample_time_s.is_some() { 1.0 - rate * STEP_S } else { exp(-rate * STEP_S) }
                };
                let powers = |decay: f64| std::iter::successors(Some(1.0), move |value| Some(value * decay));
                let answer = |rate: f64| {
                    let pairs = powers(decay(rate)).zip(powers(decay(OTHER))).take(COUNT);
                    pairs.map(|(own, other)| own - other).collect::<Vec<f64>>()
                };
                let scale = (OTHER - before) / (OTHER - after);
                let known = KnownResponses::default();
                let carried = CarriedDisturbance::new(&member, loops.each_ref(), STEP_S, COUNT, &known);
                for (found, expected) in carried.of(&answer(before)).into_iter().zip(answer(after)) {
                    assert!((found - scale * expected).abs() < 2e-3, "{found} {expected}");
                }
            }
        }
    }
}
