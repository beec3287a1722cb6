//! Step response of a loop with dead time, which is not a rational function when closed.

use nalgebra::DMatrix;

use super::{TimeResponseError, step_response, uniform_times};
use crate::linear::{Discretization, LinearError, StateSpace, TransferFunction};

/// The unit step of a continuous loop whose forward path has dead time: times in s, and the output.
///
/// ```text
/// y = W(e(t - T)),    e = F r - H y                    W the forward path without its dead time T
/// ```
///
/// The forward path is held over short steps that divide T: about `steps` of them over
/// `duration_s`, at least one to T. What is lost is of first order in the step. A dead time of the
/// sensor is taken to whole steps.
///
/// # Errors
/// [`LinearError::DeadTime`] without dead time in the forward path (close that loop exactly, by
/// `feedback`), those of the zero-order hold, and those of [`step_response`] for the prefilter.
///
/// # Example
/// e^(-s)/s closed with gain 1/2: nothing for 1 s, then a ramp, then a parabola from 2 s on
/// ```
/// use num_complex::Complex64;
/// use phea_dynamics::linear::TransferFunction;
/// use phea_dynamics::time_response::delayed_loop_step;
/// # fn main() -> Result<(), phea_dynamics::time_response::TimeResponseError> {
/// let forward = TransferFunction::from_factors(0.5, vec![], vec![Complex64::new(0.0, 0.0)])?.with_dead_time(1.0)?;
/// let one = TransferFunction::gain_only(1.0);
/// let (times, output) = delayed_loop_step(&forward, &one, &one, 3.0, 3000)?;
/// let at = |time: f64| output[times.partition_point(|other| *other < time)];
/// assert_eq!(at(0.99), 0.0);
/// assert!((at(1.6) - 0.5 * 0.6).abs() < 1e-3);
/// assert!((at(2.6) - (0.5 * 1.6 - 0.25 * 0.6 * 0.6 / 2.0)).abs() < 1e-3);
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
    let dead_time_s = forward.dead_time_s();
    let wanted_s = duration_s / steps.max(1) as f64;
    if !(dead_time_s > 0.0 && wanted_s > 0.0 && wanted_s.is_finite()) {
        return Err(LinearError::DeadTime { dead_time_s }.into());
    }
    let lag = (dead_time_s / wanted_s).ceil().min(steps.max(1) as f64).max(1.0);
    let step_s = dead_time_s / lag;
    let held = |system: &TransferFunction| -> Result<StateSpace, LinearError> {
        let rational = system.clone().with_dead_time(0.0)?;
        StateSpace::from_transfer_function(&rational)?.discretized(step_s, Discretization::ZeroOrderHold)
    };
    let (mut path, mut feedback) = (Stepped::new(held(forward)?), Stepped::new(held(sensor)?));
    let (lag, sensor_lag) = (lag as usize, (sensor.dead_time_s() / step_s).round() as usize);
    let count = (duration_s / step_s).ceil().min(STEPS_MAXIMUM) as usize + 1;
    let times = uniform_times(step_s * (count - 1) as f64, count)?;
    let reference = step_response(prefilter, &times)?;
    let (mut errors, mut outputs): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    let earlier = |values: &[f64], index: usize, lag: usize| {
        index.checked_sub(lag).and_then(|index| values.get(index)).copied().unwrap_or(0.0)
    };
    for (index, reference) in reference.iter().enumerate() {
        outputs.push(path.step(earlier(&errors, index, lag)));
        errors.push(reference - feedback.step(earlier(&outputs, index, sensor_lag)));
    }
    Ok((times, outputs))
}

/// Steps that are taken at most, where the dead time is much shorter than the time that is asked
/// for.
const STEPS_MAXIMUM: f64 = 1e6;

/// A sampled system with one input and one output, and its state.
struct Stepped {
    system: StateSpace,
    state: Vec<f64>,
}

impl Stepped {
    fn new(system: StateSpace) -> Stepped {
        Stepped { state: vec![0.0; system.order()], system }
    }

    /// The output of one sample.
    ///
    /// ```text
    /// y(k) = C x(k) + D u(k),     x(k+1) = A x(k) + B u(k)
    /// ```
    fn step(&mut self, input: f64) -> f64 {
        let (system, state) = (&self.system, &self.state);
        let row = |matrix: &DMatrix<f64>, row: usize, direct: f64| {
            let sum: f64 = matrix.row(row).iter().zip(state).map(|(entry, x)| entry * x).sum();
            sum + direct * input
        };
        let output = row(system.c(), 0, system.d()[(0, 0)]);
        let next = (0..state.len()).map(|index| row(system.a(), index, system.b()[(index, 0)])).collect();
        self.state = next;
        output
    }
}
