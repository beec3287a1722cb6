//! The unit step of the reference through prefilter and closed loop, of one plant: continuous or
//! sampled, with dead time or without, known by polynomials or by its response.

mod of_responses;

use phea_dynamics::linear::{LinearError, Polynomial, TransferFunction};
use phea_dynamics::time_response::{
    TimeResponseError, delayed_loop_step, sampled_loop_step, step_of_frequency_response, step_response,
    uniform_times,
};
use phea_dynamics::uncertain_plant::PlantCoefficients;
use phea_qft::closed_loop::{Compensation, Member};

pub(crate) use of_responses::KnownResponses;
use of_responses::real_parts;

/// A step response from the step on: fraction of the step over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepResponse {
    /// s.
    pub times_s: Vec<f64>,
    /// 0 before, 1 at the new reference.
    pub values: Vec<f64>,
}

/// Most samples of a sampled response.
const SAMPLES_MAXIMUM: usize = 100_000;

/// The response over this time, in about so many points where the loop is continuous; a sampled
/// loop has its samples.
///
/// # Errors
/// [`LinearError::NoPlant`] for a measured plant, which is not known beyond its frequencies, and
/// [`TimeResponseError`] for a system that cannot be realised.
pub fn linear_step(
    member: &Member,
    compensation: &Compensation,
    duration_s: f64,
    points: usize,
) -> Result<StepResponse, TimeResponseError> {
    linear_step_knowing(member, compensation, (duration_s, points), &KnownResponses::default())
}

/// The same with what is known of the response of this plant in a loop of the same timing and
/// sensor.
pub(crate) fn linear_step_knowing(
    member: &Member,
    compensation: &Compensation,
    (duration_s, points): (f64, usize),
    known: &KnownResponses,
) -> Result<StepResponse, TimeResponseError> {
    let prefilter = compensation.prefilter_of_step()?;
    let feedback = compensation.feedback();
    let samples =
        |sample_time_s: f64| ((duration_s / sample_time_s).ceil() as usize + 1).clamp(10, SAMPLES_MAXIMUM);
    let (times_s, values) = match member {
        Member::Continuous { plant, sensor, .. } => {
            let forward = of_coefficients(plant)?.series(feedback)?.with_dead_time(plant.dead_time_s)?;
            if forward.dead_time_s() + sensor.dead_time_s() > 0.0 {
                delayed_loop_step(&forward, sensor, &prefilter, duration_s, points)?
            } else {
                let closed = prefilter.series(&forward.feedback(sensor)?)?;
                let times_s = uniform_times(duration_s, points + 1)?;
                let values = step_response(&closed, &times_s)?;
                (times_s, values)
            }
        }
        Member::Sampled { command, with_sensor, .. } => {
            let count = samples(compensation.sample_time_s().unwrap_or(duration_s));
            sampled_loop_step(command, with_sensor, feedback, &prefilter, count)?
        }
        Member::Responding { plant, .. } => {
            let sample_time_s = compensation.sample_time_s();
            let step_s = sample_time_s.unwrap_or(duration_s / points as f64);
            let parts = real_parts(plant, compensation, known)?;
            let count = samples(step_s);
            let values = step_of_frequency_response(&parts, step_s, count, sample_time_s.is_some());
            ((0..count).map(|sample| sample as f64 * step_s).collect(), values)
        }
        Member::Measured { .. } => return Err(LinearError::NoPlant.into()),
    };
    Ok(StepResponse { times_s, values })
}

/// The command path of a plant without its dead time.
fn of_coefficients(plant: &PlantCoefficients<f64>) -> Result<TransferFunction, LinearError> {
    let (numerator, denominator) = (plant.command.numerator.clone(), plant.command.denominator.clone());
    TransferFunction::from_polynomials(&Polynomial::new(numerator), &Polynomial::new(denominator))
}
