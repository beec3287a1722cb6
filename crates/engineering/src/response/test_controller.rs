use num_complex::Complex64;
use phea_dynamics::portable::{exp_complex, magnitude};
use phea_dynamics::spectrum::{SpectralPoint, Transform, WithinRow, feedback};
use phea_qft::closed_loop::Compensation;

use super::member::power;
use super::{ReferenceSignal, ReferenceSource, SampledPair};
use crate::identify_error::RecordFault;
use crate::project::Project;
use crate::setup::{ControlError, Setup};

/// Rounding of a delay of whole rows, in rows.
const ROUNDING: f64 = 1e-6;
/// Fraction of the output's power below which a calculated reference counts as rounding: six
/// digits.
const SILENT: f64 = 1e-12;
/// Least distance of the loop from -1 in a test: a sensitivity of 5.
const DISTANCE: f64 = 0.2;
/// Fraction of the limit above which a command counts as limited.
const LIMIT: f64 = 1.0 - 1e-6;

/// Controller of a test, from the force that it reads to its recorded command.
///
/// ```text
/// u = C (F r - y),    y + u/C = F r
/// ```
///
/// F r is the reference after its prefilter; noise of y that returns through C does not contribute
/// to it. A signal d that was added to the command appears in it as d/C, and excites the loop as
/// well.
#[derive(Clone, Debug, PartialEq)]
pub struct TestController {
    compensation: Compensation,
    command_limit: Option<f64>,
}

impl TestController {
    /// Deployed `[controller]` of a project; `None` if it has no transfer function.
    ///
    /// # Errors
    /// [`ControlError`] for a controller that is not a transfer function, or cannot be sampled.
    pub fn declared(project: &Project) -> Result<Option<TestController>, ControlError> {
        let setup = Setup::new(project)?;
        let Some(controller) = &setup.controller else { return Ok(None) };
        let compensation = setup.compensation(controller)?;
        Ok(Some(TestController { compensation, command_limit: controller.command_limit }))
    }

    /// Response of C from row to row, with rows h apart, at an angle w h in radians per row.
    ///
    /// ```text
    /// continuous:  C(jw) e^(-jw T_d)
    /// sampled:     C(e^(jwT)) e^(-jw n h) h/T (1 - e^(-jwT))/(1 - e^(-jwh)),    n = ceil(T_d/h)
    /// ```
    ///
    /// The last factor is the hold over the T/h rows of a sample; it is 1 if a sample lasts one row
    /// or less.
    fn between_rows(&self, angle: f64, time_step: f64) -> Complex64 {
        let law = self.compensation.response(angle / time_step).feedback;
        let delay = self.compensation.delay_s() / time_step;
        let Some(sample_time) = self.compensation.sample_time_s() else {
            return law * turned(angle * delay);
        };
        let rows = sample_time / time_step;
        let hold = match rows > 1.0 + ROUNDING {
            true => (1.0 - turned(angle * rows)) / (rows * (1.0 - turned(angle))),
            false => Complex64::ONE,
        };
        law * turned(angle * (delay - ROUNDING).ceil().max(0.0)) * hold
    }

    /// True if a response is -1/C: a calculated reference that is noise at this frequency shows
    /// that instead of the plant, if the controller of the test was another one.
    pub(super) fn is_negative_inverse(&self, point: &SpectralPoint, time_step: f64) -> bool {
        let controller = self.between_rows(point.frequency * time_step, time_step);
        magnitude(1.0 + point.response * controller) < DISTANCE
    }

    /// Reference of a record, y + u/C.
    ///
    /// # Errors
    /// [`RecordFault`] if the command reaches its limit, and if the noise of the output is in the
    /// reference: then this controller was not that of the test.
    pub(super) fn reference(&self, record: &SampledPair) -> Result<ReferenceSignal, RecordFault> {
        let [input, output] = record.signals;
        let is_limited = |value: &&f64| self.command_limit.is_some_and(|limit| value.abs() >= LIMIT * limit);
        let limited = record.input.iter().filter(is_limited).count();
        if limited > 0 {
            return Err(RecordFault::AtLimit { input, output, rows: limited });
        }
        let inverse = |angle: f64| {
            let inverse = 1.0 / self.between_rows(angle, record.time_step);
            if inverse.is_finite() { inverse } else { Complex64::ZERO }
        };
        let errors = Transform::new(record.input.len()).filtered(&record.input, &inverse);
        let values: Vec<f64> = record.output.iter().zip(&errors).map(|(y, error)| y + error).collect();
        if power(&values) <= SILENT * power(&record.output) {
            return Err(RecordFault::FollowsFromOutput { input, output });
        }
        let within_row = match self.compensation.sample_time_s() {
            Some(_) => WithinRow::Impossible,
            None => WithinRow::Possible,
        };
        match feedback(&values, &record.output, within_row) {
            fraction if fraction > 0.0 => Err(RecordFault::OtherController { output, fraction }),
            _ => Ok(ReferenceSignal { source: ReferenceSource::Controller, values }),
        }
    }
}

/// Factor exp(-j angle).
fn turned(angle: f64) -> Complex64 {
    exp_complex(Complex64::new(0.0, -angle))
}
