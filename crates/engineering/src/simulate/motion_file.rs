//! A function of time from a CSV file: a measured motion of the load, or a recorded signal.
//!
//! ```text
//! time_s, position_mm
//! 0.000,  0.00
//! 0.010,  0.02
//! ```
//! Rows in the order of time. A motion is relative to the first row, and starts at the position of
//! the load; a signal has the values of the file, from its first row on.

use phea_dynamics::simulation::{Profile, ProfileError};

use crate::family::measured::table::{self, MeasuredCell};
use crate::project::{Findings, Project, RawFinding, Refusal};
use crate::quantity::{self, Dimension, FORCE, LENGTH, TIME, VOLTAGE};
use crate::source::Source;
use crate::spelling::nearest;

/// Columns of time with the unit of each.
const TIMES: ColumnNames = [("time_s", "s"), ("time_ms", "ms")];

/// Names of a column with the unit of each.
type ColumnNames = [(&'static str, &'static str); 2];

/// A column of values.
#[derive(Clone, Copy, Debug)]
pub(super) struct MotionColumn {
    names: ColumnNames,
    dimension: &'static Dimension,
}

impl MotionColumn {
    const POSITION: MotionColumn =
        MotionColumn { names: [("position_m", "m"), ("position_mm", "mm")], dimension: &LENGTH };
    pub(super) const FORCE: MotionColumn =
        MotionColumn { names: [("force_n", "N"), ("force_kn", "kN")], dimension: &FORCE };
    pub(super) const VOLTAGE: MotionColumn =
        MotionColumn { names: [("voltage_v", "V"), ("voltage_mv", "mV")], dimension: &VOLTAGE };
}

/// The motion as a function of time, beginning at `start_s`, or the errors of the file.
pub(super) fn motion(
    source: &dyn Source,
    project: &Project,
    file: &str,
    start_s: f64,
) -> Result<Result<Profile, ProfileError>, Box<Refusal>> {
    let rows = read(source, project, file, MotionColumn::POSITION)?;
    let (first_s, first_m) = rows.first().copied().unwrap_or_default();
    let times: Vec<f64> = rows.iter().map(|row| start_s + row.0 - first_s).collect();
    let positions: Vec<f64> = rows.iter().map(|row| row.1 - first_m).collect();
    Ok(Profile::table(&times, &positions))
}

/// The signal as a function of time, zero before its first row, or the errors of the file.
pub(super) fn signal(
    source: &dyn Source,
    project: &Project,
    file: &str,
    start_s: f64,
    column: MotionColumn,
) -> Result<Result<Profile, ProfileError>, Box<Refusal>> {
    let rows = read(source, project, file, column)?;
    let (first_s, _) = rows.first().copied().unwrap_or_default();
    let times: Vec<f64> = rows.iter().map(|row| start_s + row.0 - first_s).collect();
    let values: Vec<f64> = rows.iter().map(|row| row.1).collect();
    Ok(Profile::table(&times, &values).map(|profile| profile.begun_at(start_s)))
}

fn read(
    source: &dyn Source,
    project: &Project,
    file: &str,
    column: MotionColumn,
) -> Result<Vec<(f64, f64)>, Box<Refusal>> {
    let mut findings = Findings::default();
    let path = project.path_of(file);
    let rows = match source.read(&path) {
        Ok(bytes) => rows(&path, &bytes, column, &mut findings),
        Err(error) => {
            findings.unreadable(&path, &error.to_string());
            Vec::new()
        }
    };
    if findings.error_count() > 0 { Err(Box::new(findings.report())) } else { Ok(rows) }
}

fn rows(path: &str, bytes: &[u8], values: MotionColumn, findings: &mut Findings) -> Vec<(f64, f64)> {
    let Some(table) = table::read(path, bytes, findings) else { return Vec::new() };
    let columns = [column(&table.header, TIMES, findings), column(&table.header, values.names, findings)];
    unknown(&table.header, values.names, findings);
    let [Some(time), Some(value)] = columns else { return Vec::new() };
    let mut rows: Vec<(f64, f64)> = Vec::with_capacity(table.rows.len());
    for row in table.rows.iter().filter(|row| table.is_complete(row, findings)).collect::<Vec<_>>() {
        let numbers = [(time, &TIME), (value, values.dimension)]
            .map(|((index, unit), dimension)| number(row.get(index), unit, dimension));
        match numbers {
            [Ok(time_s), Ok(_)] if rows.last().is_some_and(|last| last.0 >= time_s) => {
                let place = row.get(time.0).map(|cell| cell.place).unwrap_or_default();
                let found = RawFinding::error(place, "times must increase from row to row");
                findings.push(found.expected("a later time"));
                return rows;
            }
            [Ok(time_s), Ok(value)] => rows.push((time_s, value)),
            [one, other] => {
                [one.err(), other.err()].into_iter().flatten().for_each(|found| findings.push(found))
            }
        }
    }
    if rows.len() < 2 && findings.error_count() == 0 {
        let place = table.header.first().map(|cell| cell.place).unwrap_or_default();
        let what = if std::ptr::eq(values.dimension, &LENGTH) { "motion" } else { "signal" };
        findings.push(RawFinding::error(place, format!("a {what} needs two rows at least")));
    }
    rows
}

/// The index of a column, and its unit.
fn column(
    header: &[MeasuredCell<'_>],
    names: ColumnNames,
    findings: &mut Findings,
) -> Option<(usize, &'static str)> {
    let unit =
        |cell: &MeasuredCell<'_>| names.iter().find(|(name, _)| *name == cell.text).map(|(_, unit)| *unit);
    let mut found =
        header.iter().enumerate().filter_map(|(index, cell)| Some((index, unit(cell)?, cell.place)));
    let (first, second) = (found.next(), found.next());
    if let Some((_, _, place)) = second {
        findings.push(RawFinding::error(place, "this column is there twice, here in another unit or again"));
    }
    if first.is_none() {
        let place = header.first().map(|cell| cell.place).unwrap_or_default();
        let [(one, _), (other, _)] = names;
        findings.push(RawFinding::error(place, format!("the columns lack `{one}` or `{other}`")));
    }
    first.map(|(index, unit, _)| (index, unit))
}

fn unknown(header: &[MeasuredCell<'_>], values: ColumnNames, findings: &mut Findings) {
    let names = || TIMES.iter().chain(&values).map(|(name, _)| *name);
    for cell in header.iter().filter(|cell| !names().any(|name| name == cell.text)) {
        let found = RawFinding::error(cell.place, format!("unknown column `{}`", cell.text));
        findings.push(match nearest(cell.text, names()) {
            Some(name) => found.help(format!("did you mean `{name}`?")),
            None => found.help(format!("known here: {}", names().collect::<Vec<_>>().join(", "))),
        });
    }
}

/// SI.
fn number(
    cell: Option<&MeasuredCell<'_>>,
    unit: &str,
    dimension: &'static Dimension,
) -> Result<f64, RawFinding> {
    let cell = cell.copied().unwrap_or(MeasuredCell { text: "", place: Default::default() });
    let bare = cell.text.parse::<f64>().is_ok_and(f64::is_finite);
    let value = bare.then(|| quantity::parse(&format!("{} {unit}", cell.text), dimension).ok()).flatten();
    value.filter(|value| value.is_finite()).ok_or_else(|| {
        RawFinding::error(cell.place, format!("`{}` is no number", cell.text))
            .expected(format!("a number in {unit}"))
    })
}
