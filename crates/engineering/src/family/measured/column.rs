//! What the columns of a measurement hold, by their names.

use crate::project::{Findings, Found};
use crate::quantity::{ANGLE, ANGULAR_FREQUENCY, Dimension, GAIN, RATIO};
use crate::table::{Column, Measurand, Sought, Table};

/// What a column may hold. A pair of magnitude and phase, or of real and imaginary part, is a response.
static MEASURANDS: [Measurand; 9] = [
    measurand("frequency", &ANGULAR_FREQUENCY),
    measurand("magnitude", &GAIN),
    measurand("phase", &ANGLE),
    measurand("real", &RATIO),
    measurand("imaginary", &RATIO),
    measurand("load_motion_magnitude", &GAIN),
    measurand("load_motion_phase", &ANGLE),
    measurand("load_motion_real", &RATIO),
    measurand("load_motion_imaginary", &RATIO),
];

const fn measurand(name: &'static str, dimension: &'static Dimension) -> Measurand {
    Measurand { name, symbol: None, dimension, may_be_share: false }
}

/// How a response is written.
#[derive(Clone, Debug)]
pub(super) enum Form {
    /// Magnitude and phase.
    Polar(Column, Column),
    /// Real and imaginary part.
    Cartesian(Column, Column),
}

/// The columns of a measurement.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    pub(super) frequency: Column,
    /// P.
    pub(super) command: Form,
    /// Pd.
    pub(super) load_motion: Option<Form>,
}

impl Form {
    pub(super) fn parts(&self) -> [&Column; 2] {
        match self {
            Form::Polar(one, other) | Form::Cartesian(one, other) => [one, other],
        }
    }

    /// Of magnitude, phase, real and imaginary part the two that are there.
    fn of(columns: [Option<Column>; 4]) -> Option<Form> {
        match columns {
            [Some(one), Some(other), None, None] => Some(Form::Polar(one, other)),
            [None, None, Some(one), Some(other)] => Some(Form::Cartesian(one, other)),
            _ => None,
        }
    }
}

impl Columns {
    /// What is looked for in a file.
    pub(super) fn sought() -> Vec<Sought<'static>> {
        MEASURANDS.iter().map(Sought::by_name).collect()
    }

    /// Reads the headings; `None` where they do not say what is needed.
    pub(super) fn find(table: &Table, findings: &mut Findings) -> Option<Columns> {
        let sought = Columns::sought();
        let before = findings.error_count();
        let found = table.columns(&sought, findings);
        for index in found.iter().flat_map(|(_, unused)| unused) {
            findings.push(table.unknown(*index, &sought));
        }
        let (columns, _) = found.filter(|_| findings.error_count() == before)?;
        let columns: [Option<Column>; 9] = columns.try_into().ok()?;
        let [frequency, magnitude, phase, real, imaginary, load @ ..] = columns;
        let has_load = load.iter().any(Option::is_some);
        let [command, load_motion] = [[magnitude, phase, real, imaginary], load].map(Form::of);
        let forms = "a magnitude and a phase (`magnitude_db` or `magnitude`, `phase_deg` or `phase_rad`), or `real` and `imaginary`";
        let mut missing = |what: String| {
            let place = table.headings.first().map(|heading| heading.place).unwrap_or_default();
            findings.push(Found::error(place, format!("the columns lack {what}")));
        };
        match (frequency, command) {
            (None, _) => missing("a frequency: `frequency_hz` or `frequency_rad_per_s`".to_string()),
            (_, None) => missing(format!("{forms}, one pair of them")),
            _ if has_load && load_motion.is_none() => {
                missing(format!(
                    "half of the load motion's pair: {forms}, each with `load_motion_` before it"
                ));
            }
            (Some(frequency), Some(command)) => return Some(Columns { frequency, command, load_motion }),
        }
        None
    }
}
