//! The linear loop of a rig with its given controller and prefilter: margins and step response.

use phea_dynamics::controller::Controller;
use phea_dynamics::frequency::{Margins, margins};
use phea_dynamics::linear::{LinearError, TransferFunction};
use phea_dynamics::time_response::{
    Interpolation, SampledSignal, StepBaseline, StepMetrics, TimeResponseError, forced_response,
    sampled_loop_step, step_metrics, step_response, uniform_times,
};
use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients};
use phea_hydraulics::linear::transfer_functions;
use phea_qft::closed_loop::{Compensation, Member};
use phea_qft::stability::{StabilityStatus, member_stability};

use crate::linear_step::{StepResponse, linear_step};

/// The closed loop and its properties.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearLoop {
    /// Controller G.
    pub controller: TransferFunction,
    /// Prefilter F: in s if it acts before the sampling of the loop.
    pub prefilter: TransferFunction,
    /// Open loop L = P G H with the delay of the loop.
    pub open_loop: TransferFunction,
    /// Gain, phase, modulus and delay margin of L.
    pub margins: Margins,
    /// Stability of the closed loop.
    pub stability: LoopStability,
    /// Step response of F P G/(1 + L), if it can be computed.
    pub step: Result<StepView, NoStep>,
}

/// Stability of a closed loop.
#[derive(Clone, Debug, PartialEq)]
pub enum LoopStability {
    /// Every pole of the closed loop decays.
    Stable,
    /// A pole of the closed loop does not decay.
    Unstable,
    /// The poles cannot be computed, with the reason.
    Unknown(UnknownStability),
}

/// Reason why the stability of a closed loop is not known.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum UnknownStability {
    /// The turns of the characteristic function cannot be counted.
    #[error("its characteristic function was not resolved")]
    Unresolved,
    /// The closed loop cannot be built.
    #[error(transparent)]
    Linear(#[from] LinearError),
}

/// Reason why there is no step response.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoStep {
    /// The response grows without bound.
    #[error("the closed loop is unstable, its response grows without bound")]
    UnstableLoop,
    /// The prefiltered reference grows without bound.
    #[error("the prefilter is unstable")]
    UnstablePrefilter,
    /// The response cannot be computed.
    #[error(transparent)]
    Loop(#[from] LoopError),
}

/// A unit step through prefilter and closed loop.
#[derive(Clone, Debug, PartialEq)]
pub struct StepView {
    /// Times, s.
    pub times_s: Vec<f64>,
    /// Force divided by the reference's height.
    pub response: Vec<f64>,
    /// Prefiltered reference divided by the reference's height.
    pub filtered_reference: Vec<f64>,
    /// Command per newton of reference, V/N.
    pub command_v_per_n: Vec<f64>,
    /// Metrics of the response, with the band of the settling time.
    pub metrics: StepMetrics,
}

/// Reason why there is no linear loop.
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
/// Relative distance between a pole and a zero below which the tail is small: about this fraction
/// of the step.
const SMALL_TAIL: f64 = 0.05;

/// The loop of a plant by its coefficients, with the derivative that its controller feeds forward.
///
/// # Errors
/// The errors of [`linear_loop`].
pub fn linear_loop_of(
    plant: &PlantCoefficients<f64>,
    controller: &Controller,
    sensor: &TransferFunction,
    band_percent: f64,
) -> Result<LinearLoop, LoopError> {
    match is_rational(controller, plant.dead_time_s, sensor) {
        true => rational_loop(&transfer_functions(plant)?.command, controller, sensor, band_percent),
        false => loop_of_member(plant.clone(), controller, sensor, band_percent),
    }
}

/// Closes the loop of plant P with a controller to which the sensor H feeds back the output.
///
/// A continuous controller in a continuous loop; a sampled one with the plant held by a zero-order
/// hold, including the delay of the loop. For a prefilter that acts before the sampling, a step
/// passes as the samples of the step response of the prefilter.
///
/// # Errors
/// [`LoopError`] for a system that cannot be built or discretised.
pub fn linear_loop(
    plant: &TransferFunction,
    controller: &Controller,
    sensor: &TransferFunction,
    band_percent: f64,
) -> Result<LinearLoop, LoopError> {
    if is_rational(controller, plant.dead_time_s(), sensor) {
        return rational_loop(plant, controller, sensor, band_percent);
    }
    let command = RationalCoefficients {
        numerator: plant.numerator().coefficients().to_vec(),
        denominator: plant.denominator().coefficients().to_vec(),
    };
    let dead_time_s = plant.dead_time_s();
    let plant = PlantCoefficients { command, disturbance: None, dead_time_s, rate: None };
    loop_of_member(plant, controller, sensor, band_percent)
}

/// True if the closed loop has a finite number of poles in s: it has neither sampling nor dead
/// time.
fn is_rational(controller: &Controller, dead_time_s: f64, sensor: &TransferFunction) -> bool {
    let late = dead_time_s + controller.timing.delay_s + sensor.dead_time_s();
    controller.timing.sample_time_s.is_none() && late == 0.0
}

/// The loop of P with G and F, all rational in s.
fn rational_loop(
    plant: &TransferFunction,
    controller: &Controller,
    sensor: &TransferFunction,
    band_percent: f64,
) -> Result<LinearLoop, LoopError> {
    let (feedback, prefilter) =
        (controller.feedback.transfer_function()?, controller.prefilter.transfer_function()?);
    let with_sensor = plant.series(sensor)?;
    let open_loop = with_sensor.series(&feedback)?;
    let stability = stability(&open_loop)?;
    let step = match () {
        () if stability == LoopStability::Unstable => Err(NoStep::UnstableLoop),
        () if !prefilter.is_stable() => Err(NoStep::UnstablePrefilter),
        () => step_view(plant, &with_sensor, &feedback, &prefilter, band_percent).map_err(NoStep::Loop),
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

/// Durations of a step that is not rational in s, s: the first in which it settles early is used.
const DURATIONS_S: [f64; 4] = [0.5, 2.0, 10.0, 60.0];

/// A loop with sampling or dead time: its stability by the turns of its characteristic function,
/// its step sample by sample, or by the method of steps.
fn loop_of_member(
    plant: PlantCoefficients<f64>,
    controller: &Controller,
    sensor: &TransferFunction,
    band_percent: f64,
) -> Result<LinearLoop, LoopError> {
    let around = Compensation::new(controller, sensor.clone())?;
    let member = around.member(plant)?;
    let with_sensor = match &member {
        Member::Continuous { plant, sensor, .. } => {
            let command = transfer_functions(plant)?.command.with_dead_time(plant.dead_time_s)?;
            command.series(sensor)?
        }
        Member::Sampled { with_sensor, .. } => with_sensor.clone(),
        Member::Responding { .. } | Member::Measured { .. } => return Err(LinearError::NoPlant.into()),
    };
    let open_loop = with_sensor.series(around.feedback())?;
    let stability = match member_stability(&member, &around).status {
        StabilityStatus::Stable => LoopStability::Stable,
        StabilityStatus::Unstable(_) => LoopStability::Unstable,
        StabilityStatus::NotResolved(_) => LoopStability::Unknown(UnknownStability::Unresolved),
    };
    let step = match stability {
        LoopStability::Unstable => Err(NoStep::UnstableLoop),
        _ if !around.prefilter().is_stable() => Err(NoStep::UnstablePrefilter),
        _ => step_of_member(&member, &around, band_percent).map_err(NoStep::Loop),
    };
    Ok(LinearLoop {
        margins: margins(&open_loop),
        controller: around.feedback().clone(),
        prefilter: around.prefilter().clone(),
        open_loop,
        stability,
        step,
    })
}

fn step_of_member(member: &Member, around: &Compensation, band_percent: f64) -> Result<StepView, LoopError> {
    let prefilter = around.prefilter_of_step()?;
    let mut shown = None;
    for duration_s in DURATIONS_S {
        let StepResponse { times_s, values } = linear_step(member, around, duration_s, 2 * SAMPLES)?;
        let metrics = step_metrics(&times_s, &values, StepBaseline::to_value(1.0), band_percent)?;
        let settled = metrics.settling.time_s().is_some_and(|time_s| time_s < 0.5 * duration_s);
        let filtered_reference = step_response(&prefilter, &times_s)?;
        shown = Some(StepView {
            command_v_per_n: command(member, around, [&times_s, &values, &filtered_reference])?,
            response: values,
            filtered_reference,
            metrics,
            times_s,
        });
        if settled {
            break;
        }
    }
    shown.ok_or(LoopError::Linear(LinearError::NoPlant))
}

/// ```text
/// u = G (F r - H y)
/// ```
fn command(
    member: &Member,
    around: &Compensation,
    [times_s, output, reference]: [&Vec<f64>; 3],
) -> Result<Vec<f64>, LoopError> {
    if let Member::Sampled { with_sensor, .. } = member {
        let one = TransferFunction::gain_only(1.0).in_domain(with_sensor.domain())?;
        let prefilter = around.prefilter_of_step()?;
        let feedback = around.feedback();
        let (_, values) = sampled_loop_step(&one, with_sensor, feedback, &prefilter, times_s.len())?;
        return Ok(values);
    }
    let signal = |values: Vec<f64>| SampledSignal::new(times_s.clone(), values, Interpolation::Linear);
    let measured = forced_response(around.sensor(), &signal(output.clone())?, times_s)?;
    let error = reference.iter().zip(&measured).map(|(reference, own)| reference - own);
    Ok(forced_response(around.feedback(), &signal(error.collect())?, times_s)?)
}

fn stability(open_loop: &TransferFunction) -> Result<LoopStability, LinearError> {
    let unity = TransferFunction::gain_only(1.0).in_domain(open_loop.domain())?;
    match open_loop.feedback(&unity) {
        Ok(closed) if closed.is_stable() => Ok(LoopStability::Stable),
        Ok(_) => Ok(LoopStability::Unstable),
        Err(error) => Ok(LoopStability::Unknown(error.into())),
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
    let brief = shown(instants(&[brief_s])?)?;
    let whole_s = duration(&through);
    if brief.metrics.settling.time_s().is_some() || whole_s <= brief_s {
        return Ok(brief);
    }
    // The small tail may also leave the band.
    let whole = shown(instants(&[brief_s, whole_s])?)?;
    Ok(if whole.metrics.settling.time_s().is_some() { whole } else { brief })
}

/// Times from 0 to the last of these ends: equally many between successive ends.
fn instants(ends_s: &[f64]) -> Result<Vec<f64>, LoopError> {
    let (mut times_s, mut start_s) = (vec![0.0], 0.0);
    for end_s in ends_s {
        let after = uniform_times(end_s - start_s, SAMPLES)?;
        times_s.extend(after.iter().skip(1).map(|time_s| start_s + time_s));
        start_s = *end_s;
    }
    Ok(times_s)
}

/// Eight time constants of the slowest pole, between a tenth of a second and a minute.
fn duration(of: &TransferFunction) -> f64 {
    let slowest = of.poles().iter().map(|pole| -pole.re).fold(f64::INFINITY, f64::min);
    if slowest > 0.0 { (8.0 / slowest).clamp(0.1, 60.0) } else { 1.0 }
}
