//! Columns of a measurement, recognised by their names.

use super::problem::MeasurementProblem;
use crate::project::{Findings, RawFinding};
use crate::quantity::{ANGLE, ANGULAR_FREQUENCY, GAIN, RATIO};
use crate::table::{Column, Measurand, MeasuredTable, Sought};

/// Quantities of columns. A pair of magnitude and phase, or of real and imaginary part, is a
/// response.
static MEASURANDS: [Measurand; 12] = [
    Measurand::of("frequency", &ANGULAR_FREQUENCY).called(&["freq", "f", "omega", "w"]),
    Measurand::of("magnitude", &GAIN).called(&["mag", "gain", "amplitude"]),
    Measurand::of("phase", &ANGLE).called(&["phi", "angle"]),
    Measurand::of("real", &RATIO),
    Measurand::of("imaginary", &RATIO),
    Measurand::of("load_motion_magnitude", &GAIN),
    Measurand::of("load_motion_phase", &ANGLE),
    Measurand::of("load_motion_real", &RATIO),
    Measurand::of("load_motion_imaginary", &RATIO),
    Measurand::of("coherence", &RATIO),
    Measurand::of("standard_deviation", &RATIO),
    Measurand::of("confidence_95", &RATIO),
];

/// Form of a response.
#[derive(Clone, Debug)]
pub(super) enum ResponseForm {
    /// Magnitude and phase.
    Polar(Column, Column),
    /// Real and imaginary part.
    Cartesian(Column, Column),
}

/// The columns of a measurement.
#[derive(Clone, Debug)]
pub(super) struct MeasurementColumns {
    pub(super) frequency: Column,
    /// Response P from the command.
    pub(super) command: ResponseForm,
    /// Response Pd from the motion of the load.
    pub(super) load_motion: Option<ResponseForm>,
    /// Radius of the disc that contains the true response with 95 % probability, in the unit of the
    /// response.
    pub(super) radius: Option<Column>,
    /// Standard deviation of the response, in the unit of the response.
    pub(super) deviation: Option<Column>,
}

impl ResponseForm {
    pub(super) fn parts(&self) -> [&Column; 2] {
        match self {
            ResponseForm::Polar(one, other) | ResponseForm::Cartesian(one, other) => [one, other],
        }
    }

    /// Response from the two columns that exist among magnitude, phase, real and imaginary part.
    fn of(columns: [Option<Column>; 4]) -> Option<ResponseForm> {
        match columns {
            [Some(one), Some(other), None, None] => Some(ResponseForm::Polar(one, other)),
            [None, None, Some(one), Some(other)] => Some(ResponseForm::Cartesian(one, other)),
            _ => None,
        }
    }
}

impl MeasurementColumns {
    /// Signals that a file may contain.
    pub(super) fn sought() -> Vec<Sought<'static>> {
        MEASURANDS.iter().map(Sought::by_name).collect()
    }

    /// Reads the headings; `None` if a required column is missing.
    pub(super) fn find(table: &MeasuredTable, findings: &mut Findings) -> Option<MeasurementColumns> {
        let sought = MeasurementColumns::sought();
        let before = findings.error_count();
        let found = table.columns(&sought, findings);
        for index in table.unnamed(&sought) {
            findings.push(table.unknown(index, &sought));
        }
        let (columns, _) = found.filter(|_| findings.error_count() == before)?;
        let columns: [Option<Column>; 12] = columns.try_into().ok()?;
        let [frequency, magnitude, phase, real, imaginary, one, two, three, four, _, deviation, radius] =
            columns;
        let load = [one, two, three, four];
        let has_load = load.iter().any(Option::is_some);
        let [command, load_motion] = [[magnitude, phase, real, imaginary], load].map(ResponseForm::of);
        let missing = match (frequency, command) {
            (None, _) => MeasurementProblem::NoFrequency,
            (_, None) => MeasurementProblem::NoResponse,
            _ if has_load && load_motion.is_none() => MeasurementProblem::HalfOfLoadMotion,
            (Some(frequency), Some(command)) => {
                return Some(MeasurementColumns { frequency, command, load_motion, radius, deviation });
            }
        };
        let place = table.headings.first().map(|heading| heading.place).unwrap_or_default();
        findings.push(RawFinding::error(place, missing.to_string()));
        None
    }
}
