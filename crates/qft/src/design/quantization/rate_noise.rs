//! The effect of sensor noise on command and output, for a rate that is fed forward or an inner
//! signal that is fed back.
//!
//! ```text
//! u = -G y_H + K (H_v v + n),    y = P u,  y_H = P H u,  v = P_v u
//! u/(K n) = 1/((1 - K H_v P_v) (1 + L))        y/(K n) = P'/(1 + L)        P' = P/(1 - K H_v P_v),  L = P' H G
//! u/n = -H_p/((1 + H_p P_p) (1 + L))           y/n = -H_p P'/(1 + L)       P' = P/(1 + H_p P_p) with an inner signal
//! rms(u) = K rms(n) sqrt(sum h(i)^2)           n white at the samples, h the response of the loop to one of them
//! ```

use super::QuantizationError;
use super::rounding_effect::{DelayedSections, SAMPLES_MAXIMUM, SampledLoop, Sums};
use crate::closed_loop::{Compensation, Member};

/// Effect of one sample of noise on the output and on the command.
type OutputAndCommand = (Sums, Sums);
type SumsOfNoise = Result<Option<OutputAndCommand>, QuantizationError>;

/// The largest effect of white noise of the rate among the plants, rms in the unit of the affected
/// signal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RateNoise {
    /// Effect on the command as the plant receives it, rms.
    pub command_rms: f64,
    /// Index of the plant with this rms.
    pub command_plant: usize,
    /// Effect on the output, rms.
    pub output_rms: f64,
    /// Index of the plant with this rms.
    pub output_plant: usize,
}

/// Effect of white noise of this rms at the samples of the rate that is fed forward.
///
/// # Errors
/// [`QuantizationError::Continuous`] for a continuous loop or a plant without polynomials;
/// [`QuantizationError::NotSettled`] for a loop that is not stable; [`QuantizationError::Linear`]
/// for a controller that cannot be run.
///
/// # Example
/// Loop with almost no feedback: the command is K n, and the output of a lag is its geometric
/// series.
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
    let size = compensation.rate_feed_forward().abs() * rms;
    worst_of(
        members,
        size,
        &mut |member, around| {
            let Member::Sampled { rate, .. } = member else { return Err(QuantizationError::Continuous) };
            let rate = rate.as_ref().map(DelayedSections::new).transpose()?;
            Ok(response(around, rate, compensation.rate_feed_forward()))
        },
        compensation,
    )
}

/// Effect of white noise of this rms at the samples of the inner signal that is fed back.
///
/// # Errors
/// Errors as for [`rate_noise`].
///
/// # Example
/// Loop without feedback: the command is k n.
/// ```
/// use phea_dynamics::controller::{Compensator, Controller, Element, InnerFeedback, Timing};
/// use phea_dynamics::linear::TransferFunction;
/// use phea_dynamics::uncertain_plant::{PlantCoefficients, RateNumerators, RationalCoefficients};
/// use phea_qft::closed_loop::Compensation;
/// use phea_qft::design::quantization::inner_noise;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let inner_feedback = InnerFeedback { gain: 20.0, ..InnerFeedback::default() };
/// let timing = Timing { sample_time_s: Some(0.1), inner_feedback, ..Timing::default() };
/// let feedback = Compensator::new(vec![Element::Gain(1e-12)]);
/// let controller = Controller { feedback, timing, ..Controller::default() };
/// let compensation = Compensation::new(&controller, TransferFunction::gain_only(1.0))?;
/// let command = RationalCoefficients { numerator: vec![5.0], denominator: vec![1.0, 5.0] };
/// let rate = |inner: f64| Some(RateNumerators {
///     command: vec![0.0], disturbance: vec![1.0, 5.0, 0.0], inner: Some([vec![inner], vec![0.0]]),
/// });
/// let plant = |inner| PlantCoefficients { command: command.clone(), disturbance: None, dead_time_s: 0.0, rate: rate(inner) };
/// let of = |inner| inner_noise(&compensation, &[compensation.member(plant(inner))?], 1e-3);
/// assert!((of(1e-9)?.command_rms - 0.02).abs() < 1e-9);
/// // p(k + 1) = (left - (1 - left) k b/5) p(k) - (1 - left) k b/5 n(k), of which the command is -k (p + n)
/// let (left, b) = ((-0.5_f64).exp(), 0.25);
/// let back = (1.0 - left) * 20.0 * b / 5.0;
/// let pole = left - back;
/// let expected = 0.02 * (1.0 + back * back / (1.0 - pole * pole)).sqrt();
/// assert!((of(b)?.command_rms - expected).abs() < 1e-9);
/// # Ok(())
/// # }
/// ```
pub fn inner_noise(
    compensation: &Compensation,
    members: &[Member],
    rms: f64,
) -> Result<RateNoise, QuantizationError> {
    let Some(feedback) = compensation.inner_feedback() else {
        return worst_of(&[], rms, &mut |_, _| Ok(None), compensation);
    };
    worst_of(
        members,
        rms,
        &mut |member, around| {
            let Member::Sampled { inner, .. } = member else { return Err(QuantizationError::Continuous) };
            let inner = inner.as_ref().map(DelayedSections::new).transpose()?;
            Ok(inner_response(
                around,
                inner,
                [DelayedSections::new(feedback)?, DelayedSections::new(feedback)?],
            ))
        },
        compensation,
    )
}

/// The largest sums of output and command over the members in their loops, times a scale.
fn worst_of(
    members: &[Member],
    size: f64,
    sums: &mut dyn FnMut(&Member, SampledLoop) -> SumsOfNoise,
    compensation: &Compensation,
) -> Result<RateNoise, QuantizationError> {
    let mut worst = RateNoise { command_rms: 0.0, command_plant: 0, output_rms: 0.0, output_plant: 0 };
    for (plant, member) in members.iter().enumerate() {
        let Member::Sampled { command, with_sensor, .. } = member else {
            return Err(QuantizationError::Continuous);
        };
        let around = SampledLoop::new(command, with_sensor, compensation.feedback())?;
        let (output, command) =
            sums(member, around)?.ok_or(QuantizationError::NotSettled { plant, samples: SAMPLES_MAXIMUM })?;
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

/// The sums of output and command of the plant after one K n; `None` if they do not settle. The
/// loop is around P', whose input is the command less the feedback through P_v.
fn response(
    mut around: SampledLoop,
    mut rate: Option<DelayedSections>,
    gain: f64,
) -> Option<OutputAndCommand> {
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

/// The sums of output and command of the plant after one n of the inner signal; `None` if they do
/// not settle. The loop is around P', whose input is the command less the feedback through P_p; H_p
/// acts on the noise and on the signal alike.
fn inner_response(
    mut around: SampledLoop,
    mut inner: Option<DelayedSections>,
    [mut of_noise, mut of_signal]: [DelayedSections; 2],
) -> Option<OutputAndCommand> {
    let mut pulse = 1.0;
    let through = |sections: &mut DelayedSections, input: f64| {
        let shown = sections.free() + sections.at_once() * input;
        sections.advance(input);
        shown
    };
    Sums::settled(&mut || {
        let noise = -through(&mut of_noise, pulse);
        pulse = 0.0;
        let (output, fed_back) = around.step([noise, 0.0]);
        let input = fed_back + noise;
        let moved = inner.as_mut().map_or(0.0, |inner| through(inner, input));
        (output, input - through(&mut of_signal, moved))
    })
}
