//! What the columns of a measurement hold, by their names.

use super::table::{MeasuredCell, MeasuredTable};
use crate::project::{Findings, Found};
use crate::quantity::{self, ANGLE, ANGULAR_FREQUENCY, Dimension, GAIN, RATIO};
use crate::spelling::nearest;

/// Names of columns, and what they hold.
static NAMES: [Name; 14] = [
    name("frequency_hz", Role::Frequency, &ANGULAR_FREQUENCY, "Hz"),
    name("frequency_rad_per_s", Role::Frequency, &ANGULAR_FREQUENCY, "rad/s"),
    name("magnitude_db", Role::Magnitude, &GAIN, "dB"),
    name("magnitude", Role::Magnitude, &RATIO, ""),
    name("phase_deg", Role::Phase, &ANGLE, "deg"),
    name("phase_rad", Role::Phase, &ANGLE, "rad"),
    name("real", Role::Real, &RATIO, ""),
    name("imaginary", Role::Imaginary, &RATIO, ""),
    name("load_motion_magnitude_db", Role::LoadMotionMagnitude, &GAIN, "dB"),
    name("load_motion_magnitude", Role::LoadMotionMagnitude, &RATIO, ""),
    name("load_motion_phase_deg", Role::LoadMotionPhase, &ANGLE, "deg"),
    name("load_motion_phase_rad", Role::LoadMotionPhase, &ANGLE, "rad"),
    name("load_motion_real", Role::LoadMotionReal, &RATIO, ""),
    name("load_motion_imaginary", Role::LoadMotionImaginary, &RATIO, ""),
];

struct Name {
    name: &'static str,
    role: Role,
    dimension: &'static Dimension,
    unit: &'static str,
}

const fn name(name: &'static str, role: Role, dimension: &'static Dimension, unit: &'static str) -> Name {
    Name { name, role, dimension, unit }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
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
pub(super) struct Column {
    index: usize,
    role: Role,
    dimension: &'static Dimension,
    /// Its unit; empty for a number.
    pub(super) unit: &'static str,
}

/// How a response is written.
#[derive(Clone, Copy, Debug)]
pub(super) enum Form {
    /// Magnitude and phase.
    Polar(Column, Column),
    /// Real and imaginary part.
    Cartesian(Column, Column),
}

/// The columns of a measurement.
#[derive(Clone, Copy, Debug)]
pub(super) struct Columns {
    pub(super) frequency: Column,
    /// P.
    pub(super) command: Form,
    /// Pd.
    pub(super) load_motion: Option<Form>,
}

impl Form {
    pub(super) fn parts(&self) -> [Column; 2] {
        match *self {
            Form::Polar(one, other) | Form::Cartesian(one, other) => [one, other],
        }
    }
}

impl Columns {
    /// Reads the first row; `None` where it does not say what is needed.
    pub(super) fn find(table: &MeasuredTable<'_>, findings: &mut Findings) -> Option<Columns> {
        let mut columns: Vec<Column> = Vec::new();
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
        let find = |role: Role| columns.iter().copied().find(|column| column.role == role);
        let form = |[magnitude, phase, real, imaginary]: [Role; 4]| match roles(
            &find,
            [magnitude, phase, real, imaginary],
        ) {
            [Some(one), Some(other), None, None] => Some(Form::Polar(one, other)),
            [None, None, Some(one), Some(other)] => Some(Form::Cartesian(one, other)),
            _ => None,
        };
        let load_roles = [
            Role::LoadMotionMagnitude,
            Role::LoadMotionPhase,
            Role::LoadMotionReal,
            Role::LoadMotionImaginary,
        ];
        let command = form([Role::Magnitude, Role::Phase, Role::Real, Role::Imaginary]);
        let load_motion = form(load_roles);
        let has_load = load_roles.iter().any(|role| find(*role).is_some());
        let forms = "a magnitude and a phase (`magnitude_db` or `magnitude`, `phase_deg` or `phase_rad`), or `real` and `imaginary`";
        let mut missing = |what: String| {
            let place = table.header.first().map(|cell| cell.place).unwrap_or_default();
            findings.push(Found::error(place, format!("the columns lack {what}")));
        };
        match (find(Role::Frequency), command) {
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

fn roles(find: &dyn Fn(Role) -> Option<Column>, roles: [Role; 4]) -> [Option<Column>; 4] {
    roles.map(find)
}

fn column(index: usize, cell: &MeasuredCell<'_>, earlier: &[Column]) -> Result<Column, Found> {
    let Some(known) = NAMES.iter().find(|known| known.name == cell.text) else {
        let found = Found::error(cell.place, format!("unknown column `{}`", cell.text));
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
        return Err(Found::error(
            cell.place,
            format!("`{}` is there twice, here in another unit or again", cell.text),
        ));
    }
    Ok(Column { index, role: known.role, dimension: known.dimension, unit: known.unit })
}

impl Column {
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
        let found = || Found::error(cell.place, format!("`{}` is no number", cell.text)).expected(expected);
        if value.is_none_or(|value| !value.is_finite()) {
            findings.push(found());
            return None;
        }
        value
    }
}
