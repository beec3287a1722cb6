//! Function of time from a table: a measured motion of the load, or a recorded signal.
//!
//! ```text
//! time_s, position_mm
//! 0.000,  0.00
//! 0.010,  0.02
//! ```
//! Rows in the order of time. A motion is relative to the first row, and starts at the position of
//! the load; a signal has the values of the file, from its first row on.

use phea_dynamics::simulation::{Profile, ProfileError};

use super::plausible::{self, PhysicalColumn};
use crate::project::{Findings, Project, RawFinding, Refusal};
use crate::quantity::{FORCE, LENGTH, RATIO, VOLTAGE};
use crate::source::Source;
use crate::table::{Column, Measurand, MeasuredTable, Sought, TIMES, not_increasing};

static POSITION: Measurand = Measurand::of("position", &LENGTH);
/// Column of forces.
pub(super) static FORCES: Measurand = Measurand::of("force", &FORCE);
/// Column of commands.
pub(super) static VOLTAGES: Measurand = Measurand::of("voltage", &VOLTAGE);
/// Column of changes of a setting.
pub(super) static CHANGES: Measurand = Measurand::of("change", &RATIO);

/// Motion as a function of time, beginning at `start_s`, or the errors of the file.
pub(super) fn motion(
    source: &dyn Source,
    project: &Project,
    file: &str,
    start_s: f64,
) -> Result<Result<Profile, ProfileError>, Box<Refusal>> {
    let rows = read(source, project, file, &POSITION)?;
    let (first_s, first_m) = rows.first().copied().unwrap_or_default();
    let times: Vec<f64> = rows.iter().map(|row| start_s + row.0 - first_s).collect();
    let positions: Vec<f64> = rows.iter().map(|row| row.1 - first_m).collect();
    Ok(Profile::table(&times, &positions))
}

/// Signal as a function of time, zero before its first row, or the errors of the file.
pub(super) fn signal(
    source: &dyn Source,
    project: &Project,
    file: &str,
    start_s: f64,
    values: &'static Measurand,
) -> Result<Result<Profile, ProfileError>, Box<Refusal>> {
    let rows = read(source, project, file, values)?;
    let (first_s, _) = rows.first().copied().unwrap_or_default();
    let times: Vec<f64> = rows.iter().map(|row| start_s + row.0 - first_s).collect();
    let values: Vec<f64> = rows.iter().map(|row| row.1).collect();
    Ok(Profile::table(&times, &values).map(|profile| profile.begun_at(start_s)))
}

fn read(
    source: &dyn Source,
    project: &Project,
    file: &str,
    values: &'static Measurand,
) -> Result<Vec<(f64, f64)>, Box<Refusal>> {
    let mut findings = Findings::default();
    let path = project.path_of(file);
    let bytes = findings.bytes_of(source, &path);
    let rows = bytes.and_then(|bytes| rows(project, &path, bytes, values, &mut findings));
    findings.or_refused(rows.unwrap_or_default())
}

fn rows(
    project: &Project,
    path: &str,
    bytes: Vec<u8>,
    values: &'static Measurand,
    findings: &mut Findings,
) -> Option<Vec<(f64, f64)>> {
    let sought = [&TIMES, values].map(Sought::by_name);
    let table = MeasuredTable::read(path, bytes, &sought, None, findings)?;
    let (columns, unused) = table.columns(&sought, findings)?;
    for (column, sought) in columns.iter().zip(&sought) {
        if column.is_none() {
            findings.push(table.missing(sought));
        }
    }
    unused.iter().for_each(|index| findings.push(table.unknown(*index, &sought)));
    let wanted: Vec<&Column> = columns.iter().flatten().collect();
    let [time, value] = wanted.as_slice() else { return None };
    let numbers = table.all_numbers(&wanted, findings);
    let [times, values_at] = numbers.as_slice() else { return None };
    rising(&table, time, times, findings);
    let value = PhysicalColumn { table: &table, column: value, dimension: values.dimension };
    plausible::check_driving(project, value, values_at, findings);
    if times.len() < 2 && findings.error_count() == 0 {
        let of = if std::ptr::eq(values, &POSITION) { "motion" } else { "signal" };
        findings.push(RawFinding::error(table.header_place(), TooFewRows(of).to_string()));
    }
    Some(times.iter().copied().zip(values_at.iter().copied()).collect())
}

/// Error for a file of a motion or a signal with less than two rows.
#[derive(Debug, thiserror::Error)]
#[error("a {0} needs two rows at least")]
struct TooFewRows(&'static str);

/// Reports the first time that is not after the one before.
pub(super) fn rising(table: &MeasuredTable, column: &Column, times: &[f64], findings: &mut Findings) {
    let mut last = f64::NEG_INFINITY;
    for (row, time) in times.iter().enumerate().filter(|(_, time)| !time.is_nan()) {
        if *time <= last {
            return findings.push(not_increasing(table, column, times, row, findings));
        }
        last = *time;
    }
}
