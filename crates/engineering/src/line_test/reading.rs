//! Recordings of a blocked line from tables.

use phea_dynamics::order;

use super::record_error::{LineRecordError, LineRecordHint};
use super::{RiseRecord, VolumeSource};
use crate::identify_error::IdentifyError;
use crate::project::{Findings, RawFinding, RecordedLoop};
use crate::quantity::{FLOW, LENGTH, PRESSURE, TIME, VOLUME};
use crate::response::{EvenRows, SampledPair, even_rows};
use crate::source::Source;
use crate::table::{Column, Measurand, MeasuredTable, Sought, TIME_NAMES, not_increasing};
use crate::tendency::Tendency;

/// A recording of a blocked line.
#[derive(Clone, Debug, PartialEq)]
pub enum LineRecord {
    /// Record of a slow pressure rise or fall.
    Rise(RiseRecord),
    /// Record of an alternating flow.
    Response(SampledPair),
}

/// Fewest rows of a rise.
const FEWEST_ROWS: usize = 10;
/// Ratio of the path of a volume to its range beyond which the flow alternates.
const SLOW: f64 = 6.0;
/// Number of blocks over which a flow is averaged to detect alternation.
const BLOCKS: usize = 200;

const SIGNALS: [Measurand; 5] = [
    Measurand::of("time", &TIME).called(TIME_NAMES),
    Measurand::of("pressure", &PRESSURE).called(&["p"]),
    Measurand::of("flow", &FLOW).called(&["q"]),
    Measurand::of("volume", &VOLUME).called(&["V"]),
    Measurand::of("position", &LENGTH).called(&["x"]),
];

/// Recordings of these files, one each. A position becomes a volume by multiplication with the
/// piston's area, m2.
///
/// # Errors
/// All errors in the files, with their places.
pub fn line_records(
    source: &dyn Source,
    files: &[String],
    piston_area: f64,
) -> Result<Vec<LineRecord>, IdentifyError> {
    let mut findings = Findings::default();
    let mut records = Vec::new();
    for file in files {
        let bytes = findings.bytes_of(source, file);
        records.extend(bytes.and_then(|bytes| record(file, bytes, piston_area, &mut findings)));
    }
    findings.or_refused(records).map_err(IdentifyError::Files)
}

fn record(file: &str, bytes: Vec<u8>, piston_area: f64, findings: &mut Findings) -> Option<LineRecord> {
    let sought: Vec<Sought<'_>> = SIGNALS.iter().map(Sought::by_name).collect();
    let table = MeasuredTable::read(file, bytes, &sought, None, findings)?;
    let (columns, _) = table.columns(&sought, findings)?;
    let [time, pressure, flow, volume, position] = <[Option<Column>; 5]>::try_from(columns).ok()?;
    let displaced = volume.map(|column| (column, VolumeSource::Volume));
    let displaced = displaced.or(position.map(|column| (column, VolumeSource::Position)));
    let displaced = displaced.or(flow.map(|column| (column, VolumeSource::Flow)));
    let mut missing = |index: usize| {
        sought.iter().skip(index).take(1).for_each(|sought| findings.push(table.missing(sought)));
    };
    let Some(pressure) = pressure else {
        missing(1);
        return None;
    };
    let Some((displaced, from)) = displaced else {
        missing(2);
        return None;
    };
    if from == VolumeSource::Flow && time.is_none() {
        missing(0);
        return None;
    }
    let before = findings.error_count();
    let wanted: Vec<&Column> = [&pressure, &displaced].into_iter().chain(time.as_ref()).collect();
    let mut numbers = table.all_numbers(&wanted, findings).into_iter();
    let (pressures, values) = (numbers.next()?, numbers.next()?);
    let times = numbers.next().unwrap_or_default();
    if findings.error_count() > before || !are_enough(&table, &pressures, findings) {
        return None;
    }
    if let Some(time) = &time {
        increasing(&table, time, &times, findings);
    }
    if findings.error_count() > before {
        return None;
    }
    let volumes = match from {
        VolumeSource::Volume => values.clone(),
        VolumeSource::Position => values.iter().map(|position| piston_area * position).collect(),
        VolumeSource::Flow => integral(&times, &values),
    };
    if from == VolumeSource::Flow && goes_back_and_forth(&times, &values, &volumes) {
        let even = even_rows(&table, time.as_ref()?, &times, vec![values, pressures], findings)?;
        table.close(findings);
        return response(file, even);
    }
    table.check_gauge(&pressure, &pressures, |row| row, findings);
    rises_with_volume(&table, [&pressure, &displaced], [&pressures, &volumes], findings);
    table.close(findings);
    let is_right = findings.error_count() == before;
    let file = file.to_string();
    is_right.then_some(LineRecord::Rise(RiseRecord { file, source: from, times, volumes, pressures }))
}

/// Flow and pressure at equal steps.
fn response(file: &str, rows: EvenRows) -> Option<LineRecord> {
    let mut signals = rows.signals.into_iter();
    Some(LineRecord::Response(SampledPair {
        file: file.to_string(),
        signals: ["flow", "pressure"],
        units: ["m3/s", "Pa"],
        time_step: rows.step,
        input: signals.next()?,
        output: signals.next()?,
        reference: None,
        // the supply and the line act on each other: no controller is needed for that
        recorded_loop: Some(RecordedLoop::Open),
        controller: None,
        operating_point: None,
        resampled: rows.resampled,
    }))
}

/// Rejects a record whose pressure falls while its volume grows.
fn rises_with_volume(
    table: &MeasuredTable,
    columns: [&Column; 2],
    [pressures, volumes]: [&[f64]; 2],
    findings: &mut Findings,
) {
    let together = Tendency::of(volumes, pressures).filter(Tendency::is_opposite);
    let Some(Tendency { correlation, rows }) = together else { return };
    let [pressure, volume] = columns.map(|column| table.heading(column).to_string());
    let hint = LineRecordHint::ChangeSign(volume.clone());
    let message = LineRecordError::PressureFalls { pressure, volume, correlation, rows };
    let found = RawFinding::error(table.header_place(), message.to_string());
    let found = found.expected(LineRecordHint::RisingPressure.to_string());
    findings.push(found.help(hint.to_string()));
}

fn are_enough(table: &MeasuredTable, rows: &[f64], findings: &mut Findings) -> bool {
    if rows.len() < FEWEST_ROWS {
        let message = LineRecordError::TooFewRows(rows.len());
        let found = RawFinding::error(table.header_place(), message.to_string());
        findings.push(found.expected(LineRecordHint::AtLeastRows(FEWEST_ROWS).to_string()));
    }
    rows.len() >= FEWEST_ROWS
}

fn increasing(table: &MeasuredTable, column: &Column, times: &[f64], findings: &mut Findings) {
    let falls = |pair: &[f64]| matches!(pair, [one, next] if next <= one);
    if let Some(row) = times.windows(2).position(falls) {
        findings.push(not_increasing(table, column, times, row + 1, findings));
    }
}

/// Integral of a flow by the trapezoidal rule, zero at the first row.
fn integral(times: &[f64], flows: &[f64]) -> Vec<f64> {
    let mut sum = 0.0;
    let mut volumes = vec![0.0];
    for (times, flows) in times.windows(2).zip(flows.windows(2)) {
        if let ([from, to], [first, second]) = (times, flows) {
            sum += (to - from) * f64::midpoint(*first, *second);
            volumes.push(sum);
        }
    }
    volumes
}

/// True if the path of the volume is much longer than the distance between its ends.
fn goes_back_and_forth(times: &[f64], flows: &[f64], volumes: &[f64]) -> bool {
    let length = flows.len().div_ceil(BLOCKS).max(1);
    let ends = times.first().zip(times.last()).map_or(0.0, |(first, last)| last - first);
    let step = ends / times.len().saturating_sub(1).max(1) as f64;
    let distance: f64 = flows.chunks(length).map(|block| step * block.iter().sum::<f64>().abs()).sum();
    let [least, most] = order::ends(volumes.iter().copied());
    distance > SLOW * (most - least)
}
