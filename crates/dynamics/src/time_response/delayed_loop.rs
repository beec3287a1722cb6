//! Step response of a closed loop with dead time, which is not a rational function.

use nalgebra::DVector;

use super::{TimeResponseError, step_response, uniform_times};
use crate::linear::matrix_exponential::ExactStep;
use crate::linear::{LinearError, StateSpace, TransferFunction};

/// Unit step response of a continuous loop with dead time: times in s, and the output.
///
/// ```text
/// y = W(e(t - T)),    e = F r - H y                    W the forward path without its dead time T
/// ```
///
/// The signals are linear over short steps that divide the dead time of the whole loop: about
/// `steps` of them over `duration_s`, at least one to the dead time. The error is of second order
/// in the step; of first order if both W and F have direct feedthrough. The dead time of the sensor
/// acts exactly: it is moved around the loop, and the output is advanced by it.
///
/// # Errors
/// [`LinearError::DeadTime`] without dead time in the loop (close that loop exactly, by
/// `feedback`), errors of a realisation, and errors of [`step_response`] for the prefilter.
///
/// # Example
/// e^(-s)/s closed with gain 1/2: zero for 1 s, then a ramp, then a parabola from 2 s on:
/// ```
/// use num_complex::Complex64;
/// use phea_dynamics::linear::TransferFunction;
/// use phea_dynamics::time_response::delayed_loop_step;
/// # fn main() -> Result<(), phea_dynamics::time_response::TimeResponseError> {
/// let forward = TransferFunction::from_factors(0.5, vec![], vec![Complex64::new(0.0,
/// 0.0)])?.with_dead_time(1.0)?; let one = TransferFunction::gain_only(1.0); let (times, output) =
/// delayed_loop_step(&forward, &one, &one, 3.0, 3000)?; let at = |time: f64|
/// output[times.partition_point(|other| *other < time)]; assert_eq!(at(0.99), 0.0);
/// assert!((at(1.6) - 0.5 * 0.6).abs() < 1e-9); assert!((at(2.6) - (0.5 * 1.6 - 0.25 * 0.6 * 0.6 /
/// 2.0)).abs() < 1e-6);
/// # Ok(())
/// # }
/// ```
pub fn delayed_loop_step(
    forward: &TransferFunction,
    sensor: &TransferFunction,
    prefilter: &TransferFunction,
    duration_s: f64,
    steps: usize,
) -> Result<(Vec<f64>, Vec<f64>), TimeResponseError> {
    let dead_time_s = forward.dead_time_s() + sensor.dead_time_s();
    let wanted_s = duration_s / steps.max(1) as f64;
    if !(dead_time_s > 0.0 && wanted_s > 0.0 && wanted_s.is_finite()) {
        return Err(LinearError::DeadTime { dead_time_s }.into());
    }
    let lag = (dead_time_s / wanted_s).ceil().min(steps.max(1) as f64).max(1.0);
    let step_s = dead_time_s / lag;
    let (mut path, mut feedback) = (RampedSystem::new(forward, step_s)?, RampedSystem::new(sensor, step_s)?);
    let (lag, earlier_s) = (lag as usize, sensor.dead_time_s());
    let count = ((duration_s + earlier_s) / step_s).ceil().min(STEPS_MAXIMUM) as usize + 1;
    let times = uniform_times(step_s * (count - 1) as f64, count)?;
    let reference = step_response(prefilter, &times)?;
    let (mut errors, mut outputs): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    let late = |errors: &[f64], index: usize| {
        index.checked_sub(lag).and_then(|index| errors.get(index)).copied().unwrap_or(0.0)
    };
    for (index, reference) in reference.iter().enumerate() {
        // before the error begins, the value at its end is zero too: its jump is at the beginning
        // of a step
        let begun = index > lag;
        let now = late(&errors, index);
        if let Some(before) = index.checked_sub(1) {
            path.advance([late(&errors, before), if begun { now } else { 0.0 }]);
        }
        let output = path.output(now);
        if let Some(before) = outputs.last() {
            feedback.advance([*before, output]);
        }
        outputs.push(output);
        errors.push(reference - feedback.output(output));
    }
    let earlier = times.iter().map(|time_s| time_s - earlier_s).zip(outputs);
    Ok(earlier.filter(|(time_s, _)| *time_s >= 0.0).unzip())
}

/// Largest number of steps, if the dead time is much shorter than the requested duration.
const STEPS_MAXIMUM: f64 = 1e6;

/// Continuous system with one input and one output over equal steps, its input linear over each.
struct RampedSystem {
    system: StateSpace,
    step: ExactStep,
    state: DVector<f64>,
}

impl RampedSystem {
    fn new(system: &TransferFunction, step_s: f64) -> Result<RampedSystem, LinearError> {
        let system = StateSpace::from_transfer_function(&system.clone().with_dead_time(0.0)?)?;
        let step = ExactStep::new(system.a(), system.b(), step_s);
        Ok(RampedSystem { state: DVector::zeros(system.order()), system, step })
    }

    /// Output y = C x + D u.
    fn output(&self, input: f64) -> f64 {
        (self.system.c() * &self.state).sum() + self.system.d().sum() * input
    }

    fn advance(&mut self, [from, to]: [f64; 2]) {
        let ExactStep { increment, constant, ramp } = &self.step;
        self.state += increment * &self.state + constant.column(0) * from + ramp.column(0) * (to - from);
    }
}
