//! Step response of a sampled loop, sample by sample: no roots of the closed loop are computed.

use nalgebra::DVector;

use super::{ResponseNumber, TimeResponseError, step_response};
use crate::linear::{LinearError, LinearOperation, StateSpace, TimeDomain, TransferFunction};
use crate::range::RequiredRange;

/// Samples of the unit step response of a loop in z: times in s, and the output.
///
/// ```text
/// u(k) = G (F r - M u),    y(k) = P u                  M the plant with its sensor, P the plant
/// ```
///
/// # Errors
/// [`LinearError::DomainMismatch`] for systems with different sample times, and errors of a
/// realisation; [`TimeResponseError::OutOfRange`] if the direct feedthrough of the loop is -1.
///
/// # Example
/// 1/(z - 1) closed with gain 1/2 approaches 1 by half at each sample
/// ```
/// use num_complex::Complex64;
/// use phea_dynamics::linear::{TimeDomain, TransferFunction};
/// use phea_dynamics::time_response::sampled_loop_step;
/// # fn main() -> Result<(), phea_dynamics::time_response::TimeResponseError> {
/// let domain = TimeDomain::Discrete { sample_time_s: 0.1 }; let in_z = |function:
/// TransferFunction| function.in_domain(domain); let sum = in_z(TransferFunction::from_factors(1.0,
/// vec![], vec![Complex64::new(1.0, 0.0)])?)?; let [half, one] =
/// [in_z(TransferFunction::gain_only(0.5))?, in_z(TransferFunction::gain_only(1.0))?]; let (times,
/// output) = sampled_loop_step(&sum, &sum, &half, &one, 4)?; assert_eq!(output, [0.0, 0.5, 0.75,
/// 0.875]); assert!((times[3] - 0.3).abs() < 1e-15);
/// # Ok(())
/// # }
/// ```
pub fn sampled_loop_step(
    plant: &TransferFunction,
    with_sensor: &TransferFunction,
    feedback: &TransferFunction,
    prefilter: &TransferFunction,
    samples: usize,
) -> Result<(Vec<f64>, Vec<f64>), TimeResponseError> {
    let TimeDomain::Discrete { sample_time_s } = plant.domain() else {
        return Err(LinearError::WrongDomain {
            operation: LinearOperation::StepBySamples,
            needed: "sampled",
        }
        .into());
    };
    if [with_sensor, feedback, prefilter].iter().any(|one| one.domain() != plant.domain()) {
        return Err(LinearError::DomainMismatch.into());
    }
    let times_s: Vec<f64> = (0..samples).map(|sample| sample as f64 * sample_time_s).collect();
    let reference = step_response(prefilter, &times_s)?;
    let [mut plant, mut measured, mut controller] =
        [Stepped::new(plant)?, Stepped::new(with_sensor)?, Stepped::new(feedback)?];
    let at_once = 1.0 + controller.gain * measured.gain;
    if at_once == 0.0 {
        let expected = RequiredRange::NotZero;
        return Err(TimeResponseError::OutOfRange {
            what: ResponseNumber::LoopAtOnce,
            value: at_once,
            expected,
        });
    }
    let mut outputs = Vec::with_capacity(samples);
    for reference in reference {
        let error = reference - measured.free();
        let command = (controller.free() + controller.gain * error) / at_once;
        controller.advance(error - measured.gain * command);
        outputs.push(plant.free() + plant.gain * command);
        measured.advance(command);
        plant.advance(command);
    }
    Ok((times_s, outputs))
}

/// Sampled system with one input and one output, and its state.
///
/// ```text
/// y(k) = C x(k) + D u(k),     x(k+1) = A x(k) + B u(k)
/// ```
struct Stepped {
    system: StateSpace,
    /// Feedthrough D.
    gain: f64,
    state: DVector<f64>,
}

impl Stepped {
    fn new(system: &TransferFunction) -> Result<Stepped, LinearError> {
        let system = StateSpace::from_transfer_function(system)?;
        Ok(Stepped { state: DVector::zeros(system.order()), gain: system.d().sum(), system })
    }

    /// Output C x without feedthrough.
    fn free(&self) -> f64 {
        (self.system.c() * &self.state).sum()
    }

    fn advance(&mut self, input: f64) {
        self.state = self.system.a() * &self.state + self.system.b().column(0) * input;
    }
}
