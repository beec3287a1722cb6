//! The effect of the noise of a rate that is fed forward on command and output.
//!
//! ```text
//! u = -G y_H + K (H_v v + n),    y = P u,  y_H = P H u,  v = P_v u
//! u/(K n) = 1/((1 - K H_v P_v) (1 + L))        y/(K n) = P'/(1 + L)        P' = P/(1 - K H_v P_v),  L = P' H G
//! rms(u) = K rms(n) sqrt(sum h(i)^2)           n white at the samples, h the response of the loop to one of them
//! ```

use super::QuantizationError;
use super::rounding_effect::{DelayedSections, SAMPLES_MAXIMUM, SampledLoop, Sums};
use crate::closed_loop::{Compensation, Member};

/// The largest effect of white noise of the rate among the plants, rms in the unit of what it acts
/// on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RateNoise {
    /// On the command as the plant receives it.
    pub command_rms: f64,
    /// Index of the plant with this rms.
    pub command_plant: usize,
    /// On the output.
    pub output_rms: f64,
    /// Index of the plant with this rms.
    pub output_plant: usize,
}

/// What white noise of this rms does, at the samples, where the rate is fed forward.
///
/// # Errors
/// [`QuantizationError::Continuous`] for a continuous loop or a plant without polynomials;
/// [`QuantizationError::NotSettled`] for a loop that is not stable; [`QuantizationError::Linear`]
/// for a controller that cannot be run.
///
/// # Example
/// With next to no feedback the command is K n, and the output of a lag is a geometric series of
/// it.
/// ```
/// use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
/// use phea_dynamics::linear::TransferFunction;
/// use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients};
/// use phea_qft::closed_loop::Compensation;
/// use phea_qft::design::quantization::rate_noise;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let timing = Timing { sample_time_s: Some(0.1), rate_feed_forward: 20.0, ..Timing::default() };
/// let feedback = Compensator::new(vec![Element::Gain(1e-12)]);
/// let controller = Controller { feedback, timing, ..Controller::default() };
/// let compensation = Compensation::new(&controller, TransferFunction::gain_only(1.0))?;
/// let command = RationalCoefficients { numerator: vec![5.0], denominator: vec![1.0, 5.0] };
/// let plant = PlantCoefficients { command, disturbance: None, dead_time_s: 0.0, rate: None };
/// let found = rate_noise(&compensation, &[compensation.member(plant)?], 1e-3)?;
/// let left = (-0.5_f64).exp(); // y(k + 1) = left y(k) + (1 - left) u(k)
/// assert!((found.command_rms - 0.02).abs() < 1e-9);
/// assert!((found.output_rms - 0.02 * ((1.0 - left) / (1.0 + left)).sqrt()).abs() < 1e-9);
/// # Ok(())
/// # }
/// ```
pub fn rate_noise(
    compensation: &Compensation,
    members: &[Member],
    rms: f64,
) -> Result<RateNoise, QuantizationError> {
    let mut worst = RateNoise { command_rms: 0.0, command_plant: 0, output_rms: 0.0, output_plant: 0 };
    let size = compensation.rate_feed_forward().abs() * rms;
    for (plant, member) in members.iter().enumerate() {
        let Member::Sampled { command, with_sensor, rate, .. } = member else {
            return Err(QuantizationError::Continuous);
        };
        let around = SampledLoop::new(command, with_sensor, compensation.feedback())?;
        let rate = rate.as_ref().map(DelayedSections::new).transpose()?;
        let (output, command) = response(around, rate, compensation.rate_feed_forward())
            .ok_or(QuantizationError::NotSettled { plant, samples: SAMPLES_MAXIMUM })?;
        let [command, output] = [command, output].map(|sums| size * sums.squares.sqrt());
        if command > worst.command_rms {
            (worst.command_rms, worst.command_plant) = (command, plant);
        }
        if output > worst.output_rms {
            (worst.output_rms, worst.output_plant) = (output, plant);
        }
    }
    Ok(worst)
}

/// The sums of what output and command of the plant do after one K n; `None` if they do not settle.
/// The loop is around P', whose input is all of the command but what P_v feeds back.
fn response(mut around: SampledLoop, mut rate: Option<DelayedSections>, gain: f64) -> Option<(Sums, Sums)> {
    let mut noise = 1.0;
    Sums::settled(&mut || {
        let (output, fed_back) = around.step([noise, 0.0]);
        let input = fed_back + noise;
        noise = 0.0;
        let moved = rate.as_mut().map_or(0.0, |rate| {
            let shown = rate.free() + rate.at_once() * input;
            rate.advance(input);
            shown
        });
        (output, input + gain * moved)
    })
}
