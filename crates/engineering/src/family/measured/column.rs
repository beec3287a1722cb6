//! What the columns of a measurement hold, by their names.

use super::table::{MeasuredCell, MeasuredTable};
use crate::project::{Findings, RawFinding};
use crate::quantity::{self, ANGLE, ANGULAR_FREQUENCY, Dimension, GAIN, RATIO};
use crate::spelling::nearest;

/// Names of columns, and what they hold.
static NAMES: [Name; 14] = [
    name("frequency_hz", ColumnRole::Frequency, &ANGULAR_FREQUENCY, "Hz"),
    name("frequency_rad_per_s", ColumnRole::Frequency, &ANGULAR_FREQUENCY, "rad/s"),
    name("magnitude_db", ColumnRole::Magnitude, &GAIN, "dB"),
    name("magnitude", ColumnRole::Magnitude, &RATIO, ""),
    name("phase_deg", ColumnRole::Phase, &ANGLE, "deg"),
    name("phase_rad", ColumnRole::Phase, &ANGLE, "rad"),
    name("real", ColumnRole::Real, &RATIO, ""),
    name("imaginary", ColumnRole::Imaginary, &RATIO, ""),
    name("load_motion_magnitude_db", ColumnRole::LoadMotionMagnitude, &GAIN, "dB"),
    name("load_motion_magnitude", ColumnRole::LoadMotionMagnitude, &RATIO, ""),
    name("load_motion_phase_deg", ColumnRole::LoadMotionPhase, &ANGLE, "deg"),
    name("load_motion_phase_rad", ColumnRole::LoadMotionPhase, &ANGLE, "rad"),
    name("load_motion_real", ColumnRole::LoadMotionReal, &RATIO, ""),
    name("load_motion_imaginary", ColumnRole::LoadMotionImaginary, &RATIO, ""),
];

struct Name {
    name: &'static str,
    role: ColumnRole,
    dimension: &'static Dimension,
    unit: &'static str,
}

const fn name(
    name: &'static str,
    role: ColumnRole,
    dimension: &'static Dimension,
    unit: &'static str,
) -> Name {
    Name { name, role, dimension, unit }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ColumnRole {
    Frequency,
    Magnitude,
    Phase,
    Real,
    Imaginary,
    LoadMotionMagnitude,
    LoadMotionPhase,
    LoadMotionReal,
    LoadMotionImaginary,
}

/// A column that is there.
#[derive(Clone, Copy, Debug)]
pub(super) struct MeasuredColumn {
    index: usize,
    role: ColumnRole,
    dimension: &'static Dimension,
    /// Its unit; empty for a number.
    pub(super) unit: &'static str,
}

/// How a response is written.
#[derive(Clone, Copy, Debug)]
pub(super) enum ResponseForm {
    /// Magnitude and phase.
    Polar(MeasuredColumn, MeasuredColumn),
    /// Real and imaginary part.
    Cartesian(MeasuredColumn, MeasuredColumn),
}

/// The columns of a measurement.
#[derive(Clone, Copy, Debug)]
pub(super) struct MeasurementColumns {
    pub(super) frequency: MeasuredColumn,
    /// P.
    pub(super) command: ResponseForm,
    /// Pd.
    pub(super) load_motion: Option<ResponseForm>,
}

impl ResponseForm {
    pub(super) fn parts(&self) -> [MeasuredColumn; 2] {
        match *self {
            ResponseForm::Polar(one, other) | ResponseForm::Cartesian(one, other) => [one, other],
        }
    }
}

impl MeasurementColumns {
    /// Reads the first row; `None` where it does not say what is needed.
    pub(super) fn find(table: &MeasuredTable<'_>, findings: &mut Findings) -> Option<MeasurementColumns> {
        let mut columns: Vec<MeasuredColumn> = Vec::new();
        let mut sound = true;
        for (index, cell) in table.header.iter().enumerate() {
            match column(index, cell, &columns) {
                Ok(column) => columns.push(column),
                Err(found) => {
                    findings.push(found);
                    sound = false;
                }
            }
        }
        if !sound {
            return None;
        }
        let find = |role: ColumnRole| columns.iter().copied().find(|column| column.role == role);
        let form = |[magnitude, phase, real, imaginary]: [ColumnRole; 4]| match roles(
            &find,
            [magnitude, phase, real, imaginary],
        ) {
            [Some(one), Some(other), None, None] => Some(ResponseForm::Polar(one, other)),
            [None, None, Some(one), Some(other)] => Some(ResponseForm::Cartesian(one, other)),
            _ => None,
        };
        let load_roles = [
            ColumnRole::LoadMotionMagnitude,
            ColumnRole::LoadMotionPhase,
            ColumnRole::LoadMotionReal,
            ColumnRole::LoadMotionImaginary,
        ];
        let command =
            form([ColumnRole::Magnitude, ColumnRole::Phase, ColumnRole::Real, ColumnRole::Imaginary]);
        let load_motion = form(load_roles);
        let has_load = load_roles.iter().any(|role| find(*role).is_some());
        let forms = "a magnitude and a phase (`magnitude_db` or `magnitude`, `phase_deg` or `phase_rad`), or `real` and `imaginary`";
        let mut missing = |what: String| {
            let place = table.header.first().map(|cell| cell.place).unwrap_or_default();
            findings.push(RawFinding::error(place, format!("the columns lack {what}")));
        };
        match (find(ColumnRole::Frequency), command) {
            (None, _) => missing("a frequency: `frequency_hz` or `frequency_rad_per_s`".to_string()),
            (_, None) => missing(format!("{forms}, one pair of them")),
            _ if has_load && load_motion.is_none() => {
                missing(format!(
                    "half of the load motion's pair: {forms}, each with `load_motion_` before it"
                ));
            }
            (Some(frequency), Some(command)) => {
                return Some(MeasurementColumns { frequency, command, load_motion });
            }
        }
        None
    }
}

fn roles(
    find: &dyn Fn(ColumnRole) -> Option<MeasuredColumn>,
    roles: [ColumnRole; 4],
) -> [Option<MeasuredColumn>; 4] {
    roles.map(find)
}

fn column(
    index: usize,
    cell: &MeasuredCell<'_>,
    earlier: &[MeasuredColumn],
) -> Result<MeasuredColumn, RawFinding> {
    let Some(known) = NAMES.iter().find(|known| known.name == cell.text) else {
        let found = RawFinding::error(cell.place, format!("unknown column `{}`", cell.text));
        let names = || NAMES.iter().map(|known| known.name);
        return Err(match nearest(cell.text, names()) {
            _ if cell.text.contains([';', '\t']) => {
                found.help("separate columns with commas, and write the decimal sign as a point")
            }
            Some(name) => found.help(format!("did you mean `{name}`?")),
            None => found.help(format!("known here: {}", names().collect::<Vec<_>>().join(", "))),
        });
    };
    if earlier.iter().any(|column| column.role == known.role) {
        return Err(RawFinding::error(
            cell.place,
            format!("`{}` is there twice, here in another unit or again", cell.text),
        ));
    }
    Ok(MeasuredColumn { index, role: known.role, dimension: known.dimension, unit: known.unit })
}

impl MeasuredColumn {
    /// Its value in a complete row.
    pub(super) fn cell<'a>(&self, row: &[MeasuredCell<'a>]) -> MeasuredCell<'a> {
        row[self.index]
    }

    /// SI.
    pub(super) fn value(&self, row: &[MeasuredCell<'_>], findings: &mut Findings) -> Option<f64> {
        let cell = self.cell(row);
        let expected =
            if self.unit.is_empty() { "a number".to_string() } else { format!("a number in {}", self.unit) };
        let bare = cell.text.parse::<f64>().is_ok_and(f64::is_finite);
        let value = match bare {
            true => quantity::parse(&format!("{} {}", cell.text, self.unit), self.dimension).ok(),
            false => None,
        };
        let found =
            || RawFinding::error(cell.place, format!("`{}` is no number", cell.text)).expected(expected);
        if value.is_none_or(|value| !value.is_finite()) {
            findings.push(found());
            return None;
        }
        value
    }
}
