//! The effect of converter rounding on force and command.
//!
//! ```text
//! y(k) = sum h(i) e(k - i),  |e| <= q/2:      |y| <= q/2 sum |h(i)|,       white e:  rms(y) = q/sqrt(12) sqrt(sum h(i)^2)
//! ```
//!
//! The responses h are those of the closed loop to one rounding error, computed sample by sample.

use std::collections::VecDeque;

use phea_dynamics::controller::Section;
use phea_dynamics::linear::{LinearError, TimeDomain, TransferFunction};

use super::{Quantization, QuantizationError};
use crate::closed_loop::{Compensation, Member};

/// Least and greatest number of samples computed.
const SAMPLES_MINIMUM: usize = 4096;
pub(super) const SAMPLES_MAXIMUM: usize = 1 << 21;
/// Fraction that the last half of the samples may add.
const SETTLED: f64 = 1e-6;

/// The largest effect of rounding over the plants, in the unit of the affected signal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundingEffect {
    /// The largest possible effect of rounding at any sample: q/2 times the sum of |h|.
    pub peak: f64,
    /// Index of the plant with this peak.
    pub peak_plant: usize,
    /// Rms effect of independent rounding errors: q/sqrt(12) times the root of the sum of h^2.
    pub rms: f64,
    /// Index of the plant with this rms.
    pub rms_plant: usize,
}

/// Ability of the loop to come to rest between the levels of its converters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LimitCycle {
    /// The controller does not integrate, so that it need not find the one command without error.
    NotIntegrating,
    /// Some level of the command leaves no error visible in the measurement, for every plant.
    CanRest {
        /// Largest change of the measurement at rest for one step of the command.
        rest_step: f64,
        /// One step of the measurement.
        measurement_step: f64,
    },
    /// A plant without such a level is possible: the command then alternates between two levels
    /// indefinitely.
    Expected {
        /// Index of the plant with the largest step.
        plant: usize,
        /// Change of the measurement at rest for one step of the command; infinite for a plant that
        /// integrates.
        rest_step: f64,
        /// One step of the measurement.
        measurement_step: f64,
    },
}

/// The effects of the converters on a loop; `None` if the converter is absent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundingEffects {
    /// Effect of the rounded command on the output.
    pub force_from_command: Option<RoundingEffect>,
    /// Effect of the rounded measurement on the output.
    pub force_from_measurement: Option<RoundingEffect>,
    /// Effect of the rounded measurement on the command.
    pub command_from_measurement: Option<RoundingEffect>,
    /// Immediate change of the command, in steps of the command, for one step of the
    /// measurement, |G(z = infinity)| q_y/q_u: far above one, the last bit of the sensor shakes the
    /// valve; far below one, the valve does not respond until the controller has integrated.
    pub command_steps_at_once: Option<f64>,
    /// Ability of the loop to come to rest.
    pub limit_cycle: Option<LimitCycle>,
}

/// Effects of rounding on the loops of these plants, at the samples.
///
/// An integrating controller can rest if one step of the command moves the measurement by less than
/// one step of the measurement,
///
/// ```text
/// |P H (z = 1)| q_u < q_y
/// ```
///
/// Source: Peterchev and Sanders (2003), the condition on resolutions. Friction and dead band of a
/// valve cause additional limit cycles, which a linear loop does not reveal.
///
/// # Errors
/// [`QuantizationError::Continuous`] for a continuous loop or a measured plant;
/// [`QuantizationError::NotSettled`] for a loop that is not stable; [`QuantizationError::Linear`]
/// for a controller that cannot be run.
///
/// # Example
/// Plant k/s with the gain g, which closes to z - 1 + K with K = g k T. A rounded command moves the
/// output by k T (1 - K)^n, in total by 1/g:
/// ```
/// use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
/// use phea_dynamics::linear::TransferFunction;
/// use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients};
/// use phea_qft::closed_loop::Compensation;
/// use phea_qft::design::quantization::{Converter, Quantization, rounding_effects};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let timing = Timing { sample_time_s: Some(0.01), ..Timing::default() };
/// let feedback = Compensator::new(vec![Element::Gain(5.0)]);
/// let controller = Controller { feedback, timing, ..Controller::default() };
/// let compensation = Compensation::new(&controller, TransferFunction::gain_only(1.0))?;
/// let command = RationalCoefficients { numerator: vec![2.0], denominator: vec![1.0, 0.0] };
/// let plant = compensation.member(PlantCoefficients { command, disturbance: None, dead_time_s: 0.0, rate: None })?;
/// let converter = Some(Converter::new(10, [-1.0, 1.0])?);
/// let quantization = Quantization { command: converter, ..Quantization::default() };
/// let effect = rounding_effects(&compensation, &[plant], &quantization)?.force_from_command.ok_or("no effect")?;
/// assert!((effect.peak - 0.5 * 2.0 / 1024.0 / 5.0).abs() < 1e-9);
/// # Ok(())
/// # }
/// ```
pub fn rounding_effects(
    compensation: &Compensation,
    members: &[Member],
    quantization: &Quantization,
) -> Result<RoundingEffects, QuantizationError> {
    let (command, measurement) =
        (quantization.command.map(|found| found.step()), quantization.measurement.map(|found| found.step()));
    let mut effects = RoundingEffects {
        force_from_command: None,
        force_from_measurement: None,
        command_from_measurement: None,
        command_steps_at_once: measurement
            .zip(command)
            .map(|(of, to)| at_once(compensation.feedback()).abs() * of / to),
        limit_cycle: None,
    };
    let mut rest: Option<(f64, usize)> = None;
    for (plant, member) in members.iter().enumerate() {
        let Member::Sampled { command: output, with_sensor, .. } = member else {
            return Err(QuantizationError::Continuous);
        };
        let sampled_loop = SampledLoop::new(output, with_sensor, compensation.feedback())?;
        let settled = |error| {
            sampled_loop
                .response(error)
                .ok_or(QuantizationError::NotSettled { plant, samples: SAMPLES_MAXIMUM })
        };
        if let Some(step) = command {
            take(&mut effects.force_from_command, settled([1.0, 0.0])?.0.effect(step, plant));
        }
        if let Some(step) = measurement {
            let (force, command) = settled([0.0, 1.0])?;
            take(&mut effects.force_from_measurement, force.effect(step, plant));
            take(&mut effects.command_from_measurement, command.effect(step, plant));
        }
        let gain = with_sensor.dc_gain().abs();
        if rest.is_none_or(|(largest, _)| gain > largest) {
            rest = Some((gain, plant));
        }
    }
    if let (Some(of), Some(to), Some((gain, plant))) = (command, measurement, rest) {
        effects.limit_cycle = Some(limit_cycle(compensation.feedback(), gain * of, to, plant));
    }
    Ok(effects)
}

fn limit_cycle(
    feedback: &TransferFunction,
    rest_step: f64,
    measurement_step: f64,
    plant: usize,
) -> LimitCycle {
    if feedback.dc_gain().is_finite() {
        LimitCycle::NotIntegrating
    } else if rest_step < measurement_step {
        LimitCycle::CanRest { rest_step, measurement_step }
    } else {
        LimitCycle::Expected { plant, rest_step, measurement_step }
    }
}

/// Direct feedthrough G(z = infinity).
fn at_once(feedback: &TransferFunction) -> f64 {
    let prompt = feedback.zeros().len() == feedback.poles().len() && feedback.dead_time_s() == 0.0;
    if prompt { feedback.gain() } else { 0.0 }
}

/// Updates the larger peak and the larger rms.
fn take(worst: &mut Option<RoundingEffect>, found: RoundingEffect) {
    let cache = worst.get_or_insert(found);
    if found.peak > cache.peak {
        (cache.peak, cache.peak_plant) = (found.peak, found.peak_plant);
    }
    if found.rms > cache.rms {
        (cache.rms, cache.rms_plant) = (found.rms, found.rms_plant);
    }
}

/// Sums of |h| and of h^2.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    magnitudes: f64,
    pub(super) squares: f64,
}

impl Sums {
    fn add(&mut self, value: f64) {
        self.magnitudes += value.abs();
        self.squares += value * value;
    }

    fn effect(&self, step: f64, plant: usize) -> RoundingEffect {
        RoundingEffect {
            peak: 0.5 * step * self.magnitudes,
            peak_plant: plant,
            rms: step * (self.squares / 12.0).sqrt(),
            rms_plant: plant,
        }
    }

    /// The sums of output and command over the samples of a loop; `None` if they do not settle.
    pub(super) fn settled(step: &mut dyn FnMut() -> (f64, f64)) -> Option<(Sums, Sums)> {
        let (mut output, mut command) = (Sums::default(), Sums::default());
        let (mut samples, mut end) = (0, SAMPLES_MINIMUM);
        while end <= SAMPLES_MAXIMUM {
            let (output_before, command_before) = (output, command);
            while samples < end {
                let (y, u) = step();
                output.add(y);
                command.add(u);
                samples += 1;
            }
            let first = end == SAMPLES_MINIMUM;
            if !first && output.settled_since(&output_before) && command.settled_since(&command_before) {
                return Some((output, command));
            }
            end *= 2;
        }
        None
    }

    fn settled_since(&self, earlier: &Sums) -> bool {
        self.magnitudes - earlier.magnitudes <= SETTLED * self.magnitudes
    }
}

/// Sections in series after whole samples of delay.
#[derive(Clone, Debug)]
pub(super) struct DelayedSections {
    sections: Vec<Section>,
    states: Vec<[f64; 2]>,
    waiting: VecDeque<f64>,
}

/// Output, measurement and controller at rest.
#[derive(Clone, Debug)]
pub(super) struct SampledLoop {
    output: DelayedSections,
    measured: DelayedSections,
    feedback: DelayedSections,
}

impl SampledLoop {
    pub(super) fn new(
        output: &TransferFunction,
        measured: &TransferFunction,
        feedback: &TransferFunction,
    ) -> Result<SampledLoop, QuantizationError> {
        let [output, measured, feedback] =
            [DelayedSections::new(output)?, DelayedSections::new(measured)?, DelayedSections::new(feedback)?];
        Ok(SampledLoop { output, measured, feedback })
    }

    /// The sums of output and command after one error of command and measurement; `None` if they do
    /// not settle.
    fn response(&self, error: [f64; 2]) -> Option<(Sums, Sums)> {
        let (mut running, mut error) = (self.clone(), error);
        Sums::settled(&mut || running.step(std::mem::take(&mut error)))
    }

    /// Advances by one sample; returns output and command.
    ///
    /// ```text
    /// u = -G m,   m = P H v + e_y,   y = P v,   v = u + e_u
    /// ```
    ///
    /// If both controller and plant have direct feedthrough, the equation is solved for u.
    pub(super) fn step(&mut self, [command_error, measurement_error]: [f64; 2]) -> (f64, f64) {
        let (plant, controller) = (self.measured.at_once(), self.feedback.at_once());
        let measured = self.measured.free() + plant * command_error + measurement_error;
        let command = (self.feedback.free() - controller * measured) / (1.0 + controller * plant);
        let input = command + command_error;
        let output = self.output.free() + self.output.at_once() * input;
        self.output.advance(input);
        self.measured.advance(input);
        self.feedback.advance(-(measured + plant * command));
        (output, command)
    }
}

impl DelayedSections {
    pub(super) fn new(function: &TransferFunction) -> Result<DelayedSections, LinearError> {
        let samples = match function.domain() {
            TimeDomain::Discrete { sample_time_s } => {
                (function.dead_time_s() / sample_time_s).round() as usize
            }
            TimeDomain::Continuous => 0,
        };
        let sections = Section::in_series(&function.clone().with_dead_time(0.0)?)?;
        let states = vec![[0.0; 2]; sections.len()];
        Ok(DelayedSections { sections, states, waiting: VecDeque::from(vec![0.0; samples]) })
    }

    /// Immediate change of the output for a unit input.
    pub(super) fn at_once(&self) -> f64 {
        if !self.waiting.is_empty() {
            return 0.0;
        }
        self.sections.iter().map(|section| section.numerator[0]).product()
    }

    /// The output without an input.
    pub(super) fn free(&self) -> f64 {
        let first = self.waiting.front().copied().unwrap_or(0.0);
        self.sections
            .iter()
            .zip(&self.states)
            .fold(first, |signal, (section, state)| section.output(*state, signal))
    }

    pub(super) fn advance(&mut self, input: f64) {
        self.waiting.push_back(input);
        let mut signal = self.waiting.pop_front().unwrap_or(input);
        for (section, state) in self.sections.iter().zip(&mut self.states) {
            let output = section.output(*state, signal);
            *state = section.advance(*state, signal, output);
            signal = output;
        }
    }
}
