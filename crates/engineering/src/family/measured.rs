//! Measured frequency responses from CSV files.
//!
//! ```text
//! # swept sine, 2 kN
//! frequency_hz, magnitude_db, phase_deg
//! 0.5,          -12.1,        -91.2
//! ```
//! A row for each frequency, columns separated by commas and named in the first row that is not a
//! comment; the unit belongs to the name.

mod column;
pub mod table;

use num_complex::Complex64;
use phea_dynamics::portable;
use phea_qft::family::{MeasuredFamily, MeasuredPlant};

use self::column::{MeasurementColumns, ResponseForm};
use self::table::{MeasuredCell, MeasuredTable};
use super::ProjectFamilyError;
use crate::project::{DeclaredFamily, Findings, Project, RawFinding, Severity};
use crate::source::Source;

/// The plants of the files, the nominal one first.
pub(super) fn family(
    project: &Project,
    declared: &DeclaredFamily,
    source: &dyn Source,
) -> Result<MeasuredFamily, ProjectFamilyError> {
    let mut findings = Findings::default();
    let mut plants = Vec::new();
    for name in &declared.measured {
        let path = project.path_of(name);
        match source.read(&path) {
            Ok(bytes) => {
                let unstable_poles = declared.unstable_poles as usize;
                plants.extend(plant(name, &path, &bytes, unstable_poles, &mut findings));
            }
            Err(error) => findings.unreadable(&path, &error.to_string()),
        }
    }
    let report = findings.report();
    if report.diagnostics.iter().any(|diagnostic| diagnostic.severity == Severity::Error) {
        return Err(ProjectFamilyError::Measurement(Box::new(report)));
    }
    Ok(MeasuredFamily::new(plants)?)
}

/// The plant of one file; `None` if it has an error.
fn plant(
    name: &str,
    path: &str,
    bytes: &[u8],
    unstable_poles: usize,
    findings: &mut Findings,
) -> Option<MeasuredPlant> {
    let table = table::read(path, bytes, findings)?;
    let columns = MeasurementColumns::find(&table, findings)?;
    let mut plant = MeasuredPlant {
        name: name.to_string(),
        frequencies_rad_per_s: Vec::with_capacity(table.rows.len()),
        command: Vec::with_capacity(table.rows.len()),
        disturbance: columns.load_motion.map(|_| Vec::with_capacity(table.rows.len())),
        unstable_poles,
        is_resolved: false,
    };
    let before = findings.error_count();
    for row in &table.rows {
        take(row, &table, &columns, &mut plant, findings);
    }
    (findings.error_count() == before).then_some(plant)
}

/// One row, if every value in it is valid.
fn take(
    row: &[MeasuredCell<'_>],
    table: &MeasuredTable<'_>,
    columns: &MeasurementColumns,
    plant: &mut MeasuredPlant,
    findings: &mut Findings,
) {
    if !table.is_complete(row, findings) {
        return;
    }
    let Some(frequency) = columns.frequency.value(row, findings) else { return };
    let previous = plant.frequencies_rad_per_s.last().copied().unwrap_or(0.0);
    if frequency <= previous {
        let message = if frequency <= 0.0 {
            "frequencies must be positive"
        } else {
            "frequencies must increase from row to row"
        };
        let unit = columns.frequency.unit;
        let cell = columns.frequency.cell(row);
        return findings
            .push(RawFinding::error(cell.place, message).expected(format!("a higher frequency in {unit}")));
    }
    let Some(command) = response(&columns.command, row, findings) else { return };
    if command == Complex64::new(0.0, 0.0) {
        let place = columns.command.parts()[0].cell(row).place;
        let found = RawFinding::error(place, "the response is zero: it has no logarithm to interpolate");
        return findings.push(found.expected("a response that is not zero, or no row for this frequency"));
    }
    if let (Some(form), Some(values)) = (&columns.load_motion, &mut plant.disturbance) {
        let Some(value) = response(form, row, findings) else { return };
        values.push(value);
    }
    plant.frequencies_rad_per_s.push(frequency);
    plant.command.push(command);
}

fn response(form: &ResponseForm, row: &[MeasuredCell<'_>], findings: &mut Findings) -> Option<Complex64> {
    let [first, second] = form.parts();
    let (one, other) = (first.value(row, findings)?, second.value(row, findings)?);
    match form {
        ResponseForm::Cartesian(..) => Some(Complex64::new(one, other)),
        ResponseForm::Polar(..) if one < 0.0 => {
            let found = RawFinding::error(first.cell(row).place, "a magnitude is not negative");
            findings.push(found.expected("the sign in the phase, as 180 degrees"));
            None
        }
        ResponseForm::Polar(..) => {
            Some(Complex64::new(one * portable::cos(other), one * portable::sin(other)))
        }
    }
}
