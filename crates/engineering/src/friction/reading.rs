use super::signs;
use crate::identify_error::{FrictionFitError, IdentifyError};
use crate::project::{Findings, Project};
use crate::quantity::{FORCE, LENGTH, PRESSURE, TIME, VELOCITY};
use crate::response::{EvenlySampled, RowSpacing, interpolated, is_software_timed, time_step};
use crate::setup::Setup;
use crate::source::Source;
use crate::table::{Column, Measurand, MeasuredTable, Sought, TIME_NAMES};

/// Facts about the cylinder that are known in addition to the files.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnownCylinder {
    /// Areas A_A and A_B, m².
    pub areas: [f64; 2],
    /// Moving mass M, kg.
    pub moving_mass: f64,
}

impl KnownCylinder {
    /// Facts that the project states.
    ///
    /// # Errors
    /// [`IdentifyError`] for a project without a cylinder.
    pub fn of(project: &Project) -> Result<KnownCylinder, IdentifyError> {
        if project.motion().is_rotary() {
            return Err(FrictionFitError::OfMotor.into());
        }
        let rig = Setup::rig_of(project)?;
        let cylinder = rig.actuator.components().cylinder;
        if cylinder.stroke.telescope().is_some() {
            return Err(FrictionFitError::Telescopic.into());
        }
        Ok(KnownCylinder { areas: [cylinder.area_a, cylinder.area_b], moving_mass: cylinder.moving_mass })
    }
}

/// Files with runs of the cylinder that a project declares in `[identify]`.
pub fn recorded_runs(project: &Project) -> Vec<String> {
    let files = project.identify.iter().flat_map(|identify| &identify.friction);
    files.map(|file| project.path_of(file)).collect()
}

/// A recorded run of the cylinder, rows at equal intervals, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct FrictionRecording {
    /// Path of the file.
    pub file: String,
    /// Time between rows, s.
    pub time_step: f64,
    /// Position at each row, m: recorded, or the integral of the recorded velocity.
    pub positions: Vec<f64>,
    /// True if the position itself was recorded.
    pub has_position: bool,
    /// Force at each row, N: A_A p_A - A_B p_B - F_e, which drives the mass against its friction.
    pub forces: Vec<f64>,
}

const MEASURANDS: [Measurand; 6] = [
    Measurand::of("time", &TIME).called(TIME_NAMES),
    Measurand::of("position", &LENGTH),
    Measurand::of("velocity", &VELOCITY),
    Measurand::of("pressure_a", &PRESSURE).called(&["p_A"]),
    Measurand::of("pressure_b", &PRESSURE).called(&["p_B"]),
    Measurand::of("force", &FORCE),
];

/// Runs in these files, one each.
///
/// # Errors
/// All errors in the files, with their places.
pub fn friction_recordings(
    source: &dyn Source,
    files: &[String],
    known: &KnownCylinder,
) -> Result<Vec<FrictionRecording>, IdentifyError> {
    let mut findings = Findings::default();
    let mut recordings = Vec::new();
    for file in files {
        let bytes = findings.bytes_of(source, file);
        recordings.extend(bytes.and_then(|bytes| recording(file, bytes, known, &mut findings)));
    }
    findings.or_refused(recordings).map_err(IdentifyError::Files)
}

fn recording(
    file: &str,
    bytes: Vec<u8>,
    known: &KnownCylinder,
    findings: &mut Findings,
) -> Option<FrictionRecording> {
    let sought: Vec<Sought<'_>> = MEASURANDS.iter().map(Sought::by_name).collect();
    let table = MeasuredTable::read(file, bytes, &sought, None, findings)?;
    let (columns, _) = table.columns(&sought, findings)?;
    let before = findings.error_count();
    let of = |index: usize| columns.get(index).and_then(Option::as_ref);
    let [time, position, velocity, pressure_a, pressure_b, force] = [0, 1, 2, 3, 4, 5].map(of);
    let mut missing = |index: usize| {
        sought.get(index).into_iter().for_each(|sought| findings.push(table.missing(sought)));
    };
    if time.is_none() {
        missing(0);
    }
    if position.or(velocity).is_none() {
        missing(1);
    }
    match (pressure_a, pressure_b, force) {
        (Some(_), None, _) => missing(4),
        (None, Some(_), _) => missing(3),
        (None, None, None) => [3, 4].into_iter().for_each(missing),
        _ => {}
    }
    if findings.error_count() > before {
        return None;
    }
    let used: Vec<&Column> =
        [time, position.or(velocity), pressure_a, pressure_b, force].into_iter().flatten().collect();
    let mut numbers = table.all_numbers(&used, findings).into_iter();
    if findings.error_count() > before {
        return None;
    }
    let (times, motion) = (numbers.next()?, numbers.next()?);
    let mut next = |column: Option<&Column>| column.and_then(|_| numbers.next()).unwrap_or_default();
    let [pressures_a, pressures_b, loads] = [pressure_a, pressure_b, force].map(&mut next);
    for (column, pressures) in [(pressure_a, &pressures_a), (pressure_b, &pressures_b)] {
        column.into_iter().for_each(|column| table.check_gauge(column, pressures, |row| row, findings));
    }
    signs::velocity_along_position(&table, position, velocity, &motion, findings);
    if findings.error_count() > before {
        return None;
    }
    let spacing = RowSpacing::of(&times);
    // a run of the cylinder is slow compared with its rows: a line between two of them changes
    // nothing
    let (time_step, motion, [pressures_a, pressures_b, loads]) = if is_software_timed(&spacing, &times) {
        let even = |values: &[f64]| interpolated(&times, values, spacing.usual);
        (spacing.usual, even(&motion), [&pressures_a, &pressures_b, &loads].map(|values| even(values)))
    } else {
        let step = time_step(&table, time?, &times, EvenlySampled::CylinderRun, findings)?;
        (step, motion, [pressures_a, pressures_b, loads])
    };
    let at = |values: &[f64], row: usize| values.get(row).copied().unwrap_or(0.0);
    let [a, b] = known.areas;
    let drive = |row: usize| a * at(&pressures_a, row) - b * at(&pressures_b, row) - at(&loads, row);
    let forces: Vec<f64> = (0..motion.len()).map(drive).collect();
    let positions = if position.is_some() { motion } else { integrated(&motion, time_step) };
    let pushing = [pressure_a, pressure_b, force];
    signs::force_along_motion(&table, position.or(velocity)?, pushing, [&positions, &forces], findings);
    table.close(findings);
    let (file, has_position) = (file.to_string(), position.is_some());
    let is_right = findings.error_count() == before;
    is_right.then_some(FrictionRecording { file, time_step, positions, has_position, forces })
}

/// Integral by the trapezoidal rule, from zero.
fn integrated(velocities: &[f64], time_step: f64) -> Vec<f64> {
    let mut position = 0.0;
    let mut before = velocities.first().copied().unwrap_or(0.0);
    let mut next = |velocity: &f64| {
        position += f64::midpoint(before, *velocity) * time_step;
        before = *velocity;
        position
    };
    velocities.iter().map(&mut next).collect()
}
