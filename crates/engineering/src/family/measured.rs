//! Measured frequency responses from tables.
//!
//! ```text
//! # swept sine, 2 kN
//! frequency_hz, magnitude_db, phase_deg
//! 0.5,          -12.1,        -91.2
//! ```
//! Each frequency has a row; the unit belongs to the name of a column.

mod column;
mod disc;
mod problem;
mod smooth;

use num_complex::Complex64;
use phea_dynamics::portable;
use phea_qft::family::{MeasuredFamily, MeasuredPlant};

use self::column::{MeasurementColumns, ResponseForm};
use self::problem::{ExpectedValue, MeasurementProblem};
use self::smooth::{Discs, smoothed};
use super::ProjectFamilyError;
use crate::project::{DeclaredFamily, Findings, Project};
use crate::source::Source;
use crate::table::{Column, MeasuredTable};

/// Plants of the files, the nominal one first.
pub(super) fn family(
    project: &Project,
    declared: &DeclaredFamily,
    source: &dyn Source,
) -> Result<MeasuredFamily, ProjectFamilyError> {
    let mut findings = Findings::default();
    let mut plants = Vec::new();
    for name in &declared.measured {
        let path = project.path_of(name);
        let bytes = findings.bytes_of(source, &path);
        let read = bytes.and_then(|bytes| plant(name, &path, bytes, &mut findings));
        plants.extend(read.map(|plant| MeasuredPlant {
            unstable_poles: declared.unstable_poles as usize,
            integrators: declared.integrators.map(|count| count as usize),
            ..plant
        }));
    }
    Ok(MeasuredFamily::new(findings.or_refused(plants).map_err(ProjectFamilyError::Measurement)?)?)
}

/// Plant of one file; `None` if it has an error.
fn plant(name: &str, path: &str, bytes: Vec<u8>, findings: &mut Findings) -> Option<MeasuredPlant> {
    let table = MeasuredTable::read(path, bytes, &MeasurementColumns::sought(), None, findings)?;
    let columns = MeasurementColumns::find(&table, findings)?;
    let forms = || std::iter::once(&columns.command).chain(&columns.load_motion);
    let spread: Vec<&Column> = columns.radius.iter().chain(&columns.deviation).collect();
    let wanted: Vec<&Column> = std::iter::once(&columns.frequency)
        .chain(spread.iter().copied())
        .chain(forms().flat_map(ResponseForm::parts))
        .collect();
    let before = findings.error_count();
    let numbers = table.all_numbers(&wanted, findings);
    let (frequencies, rest) = numbers.split_first()?;
    let (spread, parts) = rest.split_at(spread.len());
    rising(&table, &columns.frequency, frequencies, findings);
    let radii = columns.radius.as_ref().zip(spread.first());
    if let Some((column, radii)) = radii {
        for row in (0..radii.len()).filter(|row| radii.get(*row).is_some_and(|radius| *radius < 0.0)) {
            let problem = MeasurementProblem::NegativeRadius;
            report(&table, row, column, problem, ExpectedValue::Radius, findings);
        }
    }
    let responses: Vec<Vec<Complex64>> = forms()
        .zip(parts.chunks_exact(2))
        .map(|(form, parts)| responses(&table, form, parts, findings))
        .collect();
    let mut responses = responses.into_iter();
    let command = responses.next()?;
    for row in (0..command.len()).filter(|row| command.get(*row) == Some(&Complex64::new(0.0, 0.0))) {
        let (problem, expected) = (MeasurementProblem::ZeroResponse, ExpectedValue::NonzeroResponse);
        report(&table, row, columns.command.parts()[0], problem, expected, findings);
    }
    let (command, radii) = match radii {
        Some((_, radii)) if findings.error_count() == before => {
            within_discs(frequencies, command, radii, spread.get(1))
        }
        _ => (command, Vec::new()),
    };
    let plant = MeasuredPlant {
        name: name.to_string(),
        frequencies_rad_per_s: frequencies.clone(),
        command,
        disturbance: responses.next(),
        unstable_poles: 0,
        radii,
        integrators: None,
        is_resolved: false,
    };
    (findings.error_count() == before).then_some(plant)
}

/// Response, and radii of the discs that contain it simultaneously in all rows, narrowed where it
/// is smooth.
fn within_discs(
    frequencies: &[f64],
    response: Vec<Complex64>,
    radii: &[f64],
    stated: Option<&Vec<f64>>,
) -> (Vec<Complex64>, Vec<f64>) {
    let deviations = disc::deviations(radii, stated);
    let radii = disc::of_all_rows(radii, stated);
    let discs = Discs { frequencies, response: &response, deviations: &deviations, radii: &radii };
    smoothed(&discs).unwrap_or((response, radii))
}

/// Reports a problem of a value, with the expected value.
fn report(
    table: &MeasuredTable,
    row: usize,
    column: &Column,
    problem: MeasurementProblem,
    expected: ExpectedValue,
    findings: &mut Findings,
) {
    let found = table.error(row, column, problem.to_string(), findings);
    findings.push(found.expected(expected.to_string()));
}

/// Reports frequencies that are not above the greatest one before.
fn rising(table: &MeasuredTable, column: &Column, frequencies: &[f64], findings: &mut Findings) {
    let mut greatest = 0.0;
    for (row, frequency) in frequencies.iter().enumerate().filter(|(_, frequency)| !frequency.is_nan()) {
        if *frequency > greatest {
            greatest = *frequency;
            continue;
        }
        let problem = match *frequency <= 0.0 {
            true => MeasurementProblem::FrequencyNotPositive,
            false => MeasurementProblem::FrequencyNotRising,
        };
        let expected = ExpectedValue::HigherFrequency { unit: column.unit.clone() };
        report(table, row, column, problem, expected, findings);
    }
}

/// Response in all rows, from its two parts.
fn responses(
    table: &MeasuredTable,
    form: &ResponseForm,
    parts: &[Vec<f64>],
    findings: &mut Findings,
) -> Vec<Complex64> {
    let [ones, others] = parts else { return Vec::new() };
    let mut values = Vec::with_capacity(ones.len());
    for (row, (one, other)) in ones.iter().zip(others).enumerate() {
        let is_polar = matches!(form, ResponseForm::Polar(..));
        if is_polar && *one < 0.0 {
            let problem = MeasurementProblem::NegativeMagnitude;
            report(table, row, form.parts()[0], problem, ExpectedValue::SignInPhase, findings);
        }
        values.push(match form {
            ResponseForm::Cartesian(..) => Complex64::new(*one, *other),
            ResponseForm::Polar(..) => {
                Complex64::new(one * portable::cos(*other), one * portable::sin(*other))
            }
        });
    }
    values
}
