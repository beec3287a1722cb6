//! The linear loop of a rig with its given controller and prefilter: margins and step response.

pub mod of_responses;

use phea_dynamics::controller::Controller;
use phea_dynamics::frequency::{Margins, margins};
use phea_dynamics::linear::{Discretization, LinearError, TimeDomain, TransferFunction};
use phea_dynamics::time_response::{
    Settling, StepBaseline, StepMetrics, TimeResponseError, step_metrics, step_response, uniform_times,
};
use phea_dynamics::uncertain_plant::PlantCoefficients;
use phea_hydraulics::linear::transfer_functions;
use phea_qft::closed_loop::{Compensation, Member};

/// The closed loop and its properties.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearLoop {
    /// G
    pub controller: TransferFunction,
    /// F: in s where it acts before the samples of the loop.
    pub prefilter: TransferFunction,
    /// L = P G H with the delay of the loop.
    pub open_loop: TransferFunction,
    /// Gain, phase, modulus and delay margin of L.
    pub margins: Margins,
    /// Whether the closed loop is stable.
    pub stability: LoopStability,
    /// F P G/(1 + L), where it can be computed.
    pub step: Result<StepView, String>,
}

/// Whether a closed loop is stable.
#[derive(Clone, Debug, PartialEq)]
pub enum LoopStability {
    /// Every pole of the closed loop decays.
    Stable,
    /// A pole of the closed loop does not decay.
    Unstable,
    /// Its poles cannot be computed, with the reason.
    Unknown(String),
}

/// A unit step through prefilter and closed loop.
#[derive(Clone, Debug, PartialEq)]
pub struct StepView {
    /// s
    pub times_s: Vec<f64>,
    /// Force over the reference's height.
    pub response: Vec<f64>,
    /// The prefiltered reference over its height.
    pub filtered_reference: Vec<f64>,
    /// The command per newton of reference, V/N.
    pub command_v_per_n: Vec<f64>,
    /// With the band of the settling time.
    pub metrics: StepMetrics,
}

/// Why there is no linear loop.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LoopError {
    /// A system cannot be built.
    #[error(transparent)]
    Linear(#[from] LinearError),
    /// A response cannot be computed.
    #[error(transparent)]
    Time(#[from] TimeResponseError),
}

/// Number of samples of a step response.
const SAMPLES: usize = 2000;
/// A pole that is this close to a zero, relative to its own magnitude, leaves a tail of about this
/// part of the step.
const SMALL_TAIL: f64 = 0.05;

/// The loop of a plant as [`linear_loop`] closes it, with the rate that its controller feeds
/// forward at its samples.
///
/// # Errors
/// Those of [`linear_loop`].
pub fn linear_loop_of(
    plant: &PlantCoefficients<f64>,
    controller: &Controller,
    sensor: &TransferFunction,
    band_percent: f64,
) -> Result<LinearLoop, LoopError> {
    let timing = controller.timing;
    if timing.sample_time_s.is_none() || timing.rate_feed_forward == 0.0 || plant.rate.is_none() {
        return linear_loop(&transfer_functions(plant)?.command, controller, sensor, band_percent);
    }
    let around = Compensation::new(controller, sensor.clone())?;
    let Member::Sampled { command, with_sensor, .. } = around.member(plant.clone())? else {
        return Err(LinearError::DomainMismatch.into());
    };
    let prefilters = [around.prefilter().clone(), around.prefilter_of_step()?];
    closed(&command, &with_sensor, around.feedback().clone(), prefilters, band_percent)
}

/// Closes the loop of plant P with a controller that sees the output through the sensor H.
///
/// A continuous controller in a continuous loop; a sampled one with the plant held by a zero-order
/// hold, the delay of the loop in it. For a prefilter that acts before the sampling, a step passes
/// as the samples of the step response of the prefilter.
///
/// # Errors
/// A system that cannot be built or discretised.
pub fn linear_loop(
    plant: &TransferFunction,
    controller: &Controller,
    sensor: &TransferFunction,
    band_percent: f64,
) -> Result<LinearLoop, LoopError> {
    let (feedback, prefilter) =
        (controller.feedback.transfer_function()?, controller.prefilter.transfer_function()?);
    let delay_s = controller.timing.delay_s;
    let (plant, with_sensor, feedback, prefilter, of_step) = match controller.timing.sample_time_s {
        None => {
            let late = plant.clone().with_dead_time(delay_s)?;
            let with_sensor = late.series(sensor)?;
            (late, with_sensor, feedback, prefilter.clone(), prefilter)
        }
        Some(sample_time_s) => {
            let sampled = |function: TransferFunction| match function.domain() {
                TimeDomain::Continuous => {
                    function.discretized(sample_time_s, controller.timing.discretization)
                }
                TimeDomain::Discrete { .. } => Ok(function),
            };
            let held = |function: TransferFunction| {
                function.discretized(sample_time_s, Discretization::ZeroOrderHold)
            };
            let late = plant.clone().with_dead_time(delay_s)?;
            let with_sensor = held(late.series(sensor)?)?;
            let [acts, of_step] = match controller.timing.continuous_prefilter {
                true => [prefilter.clone(), held(prefilter)?],
                false => [sampled(prefilter.clone())?, sampled(prefilter)?],
            };
            (held(late)?, with_sensor, sampled(feedback)?, acts, of_step)
        }
    };
    closed(&plant, &with_sensor, feedback, [prefilter, of_step], band_percent)
}

/// The loop of P and P H with G, and with F itself and as a step passes through it.
fn closed(
    plant: &TransferFunction,
    with_sensor: &TransferFunction,
    feedback: TransferFunction,
    [prefilter, of_step]: [TransferFunction; 2],
    band_percent: f64,
) -> Result<LinearLoop, LoopError> {
    let open_loop = with_sensor.series(&feedback)?;
    let stability = stability(&open_loop)?;
    let step = match () {
        () if stability == LoopStability::Unstable => {
            Err("the closed loop is unstable, its response grows without bound".to_string())
        }
        () if !prefilter.is_stable() => Err("the prefilter is unstable".to_string()),
        () => step_view(plant, with_sensor, &feedback, &of_step, band_percent)
            .map_err(|error| error.to_string()),
    };
    Ok(LinearLoop {
        margins: margins(&open_loop),
        controller: feedback,
        prefilter,
        open_loop,
        stability,
        step,
    })
}

fn stability(open_loop: &TransferFunction) -> Result<LoopStability, LinearError> {
    let reason = |words: String| Ok(LoopStability::Unknown(words));
    if open_loop.dead_time_s() > 0.0 && open_loop.domain() == TimeDomain::Continuous {
        return reason("with dead time it has no finite number of poles".to_string());
    }
    let unity = TransferFunction::gain_only(1.0).in_domain(open_loop.domain())?;
    match open_loop.feedback(&unity) {
        Ok(closed) if closed.is_stable() => Ok(LoopStability::Stable),
        Ok(_) => Ok(LoopStability::Unstable),
        Err(error) => reason(error.to_string()),
    }
}

fn step_view(
    plant: &TransferFunction,
    with_sensor: &TransferFunction,
    feedback: &TransferFunction,
    prefilter: &TransferFunction,
    band_percent: f64,
) -> Result<StepView, LoopError> {
    // U/R = F G/(1 + G P H), closed from the factors of G and P H; the poles of P are its zeros and
    // cancel exactly in Y = P U.
    let command = prefilter.series(&feedback.feedback(with_sensor)?)?;
    let through = command.series(plant)?.without_common_factors(0.0);
    let shown = |times_s: Vec<f64>| -> Result<StepView, LoopError> {
        let response = step_response(&through, &times_s)?;
        let baseline = StepBaseline::to_value(1.0);
        let metrics = step_metrics(&times_s, &response, baseline, band_percent)?;
        Ok(StepView {
            filtered_reference: step_response(prefilter, &times_s)?,
            command_v_per_n: step_response(&command, &times_s)?,
            metrics,
            response,
            times_s,
        })
    };
    let brief_s = duration(&through.without_common_factors(SMALL_TAIL));
    let brief = shown(instants(&[brief_s], plant.domain())?)?;
    let whole_s = duration(&through);
    if brief.metrics.settling.time_s().is_some() || whole_s <= brief_s {
        return Ok(brief);
    }
    // The small tail, too, may lead out of the band.
    let whole = shown(instants(&[brief_s, whole_s], plant.domain())?)?;
    Ok(if whole.metrics.settling.time_s().is_some() { whole } else { brief })
}

/// Times from 0 to the last of these ends: equally many up to each end from the one before, and in
/// a sampled loop every sample.
fn instants(ends_s: &[f64], domain: TimeDomain) -> Result<Vec<f64>, LoopError> {
    let mut times_s = vec![0.0];
    match domain {
        TimeDomain::Continuous => {
            let mut start_s = 0.0;
            for end_s in ends_s {
                let after = uniform_times(end_s - start_s, SAMPLES)?;
                times_s.extend(after.iter().skip(1).map(|time_s| start_s + time_s));
                start_s = *end_s;
            }
        }
        TimeDomain::Discrete { sample_time_s } => {
            let duration_s = ends_s.last().copied().unwrap_or(0.0);
            let samples = (duration_s / sample_time_s).ceil().clamp(10.0, 100_000.0) as usize;
            times_s.extend((1..samples).map(|sample| sample as f64 * sample_time_s));
        }
    }
    Ok(times_s)
}

/// Eight time constants of the slowest pole, between a tenth of a second and a minute.
fn duration(of: &TransferFunction) -> f64 {
    let rate = |pole: &num_complex::Complex64| match of.domain() {
        TimeDomain::Continuous => -pole.re,
        TimeDomain::Discrete { sample_time_s } => {
            -phea_dynamics::portable::ln(phea_dynamics::portable::magnitude(*pole).max(1e-300))
                / sample_time_s
        }
    };
    let slowest = of.poles().iter().map(rate).fold(f64::INFINITY, f64::min);
    if slowest > 0.0 { (8.0 / slowest).clamp(0.1, 60.0) } else { 1.0 }
}

/// A settling time in words, with its band.
pub fn settling_words(metrics: &StepMetrics) -> String {
    let band = crate::quantity::significant(metrics.settling_band_percent, 2);
    match metrics.settling {
        Settling::Settled { time_s, .. } => {
            format!("{} s (band {band} %)", crate::quantity::significant(time_s, 3))
        }
        _ => format!("not settled within the time shown (band {band} %)"),
    }
}
