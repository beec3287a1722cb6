//! Selection of the rows of a file: gaps, duplicates, and the order in time.

use phea_dynamics::order::median;

use super::Taken;
use super::error::{RecordedTestError, RecordedTestHint};
use crate::followed::roughness;
use crate::project::{Findings, RawFinding, TestSignal};
use crate::table::{Column, ColumnNumbers, MeasuredTable, not_increasing};

/// Largest fraction of gaps in a recorded column.
const MOST_GAPS: f64 = 0.5;

/// Bounds within which no row is an outlier: rows of a slow command, standard deviations of its
/// noise, and fraction of its greatest value.
const STEPS: f64 = 3.0;
const ROUGH: f64 = 10.0;
const LEAST_OUTLIER: f64 = 1e-3;

/// Largest fraction of outliers: a command with more of them moves in this way.
const MOST_OUTLIERS: f64 = 0.05;

/// Selects the rows that are used, and reports missing values. Rows without an input, and rows that
/// repeat the row before, are omitted. Times that do not increase are errors. A command beyond
/// plausible values is retained, to be rejected later.
pub(super) fn used(
    table: &MeasuredTable,
    columns: &[(TestSignal, Column)],
    (numbers, plausible_v): (&ColumnNumbers, f64),
    is_input: impl Fn(TestSignal) -> bool,
    findings: &mut Findings,
) -> Vec<bool> {
    let rows = numbers.columns.first().map_or(0, Vec::len);
    let mut is_used = vec![true; rows];
    if let (Some(row), Some((_, first))) = (numbers.cut_off, columns.first()) {
        let message = RecordedTestError::LastRowCutOff.to_string();
        findings.push(table.warning(&[row], first, &message, findings));
    }
    for place in table.left_out() {
        findings.push(RawFinding::warning(*place, RecordedTestError::RowWithoutNumbers.to_string()));
    }
    for ((signal, column), gaps) in columns.iter().zip(&numbers.gaps) {
        if gaps.is_empty() {
            continue;
        }
        let heading = table.heading(column).to_string();
        if gaps.len() as f64 > MOST_GAPS * rows as f64 {
            let message = RecordedTestError::MostlyGaps { heading, gaps: gaps.len(), rows }.to_string();
            let found = table.error(gaps.first().copied().unwrap_or(0), column, message, findings);
            findings.push(found.help(RecordedTestHint::LeaveColumnOut.to_string()));
            continue;
        }
        let message = if is_input(*signal) {
            gaps.iter().for_each(|row| is_used.get_mut(*row).into_iter().for_each(|used| *used = false));
            RecordedTestError::GapsLeftOut(heading)
        } else {
            RecordedTestError::GapsNotRead(heading)
        };
        findings.push(table.warning(gaps, column, &message.to_string(), findings));
    }
    leave_out_repeated(table, columns, numbers, &mut is_used, findings);
    leave_out_outliers(table, columns, (numbers, plausible_v), &mut is_used, findings);
    is_used
}

/// Omits rows whose command deviates from those around it: a memory that follows it would have
/// moved there and back.
fn leave_out_outliers(
    table: &MeasuredTable,
    columns: &[(TestSignal, Column)],
    (numbers, plausible_v): (&ColumnNumbers, f64),
    is_used: &mut [bool],
    findings: &mut Findings,
) {
    let mut named = columns.iter().zip(&numbers.columns);
    let Some(((_, column), commands)) = named.find(|((signal, _), _)| *signal == TestSignal::Command) else {
        return;
    };
    let used: Vec<usize> = (0..commands.len()).filter(|row| is_used.get(*row) == Some(&true)).collect();
    let values: Vec<f64> = used.iter().filter_map(|row| commands.get(*row).copied()).collect();
    let is_plausible = |place: &usize| values.get(*place).is_some_and(|value| value.abs() <= plausible_v);
    let out = outliers(&values).into_iter().filter(is_plausible);
    let out: Vec<usize> = out.filter_map(|one| used.get(one).copied()).collect();
    if out.is_empty() {
        return;
    }
    out.iter().for_each(|row| is_used.get_mut(*row).into_iter().for_each(|used| *used = false));
    let message = RecordedTestError::Outlier(table.heading(column).to_string());
    findings.push(table.warning(&out, column, &message.to_string(), findings));
}

/// Indices of rows at which a slow command is further from the median of five than it moves in
/// three rows, and than ten standard deviations of its noise; empty if there are too many to be
/// outliers.
fn outliers(command: &[f64]) -> Vec<usize> {
    let steps = command.iter().zip(command.iter().skip(1)).map(|(before, now)| (now - before).abs());
    let greatest = command.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    let noise = ROUGH * roughness(command);
    let most = (STEPS * median(steps.collect())).max(noise).max(LEAST_OUTLIER * greatest);
    let around = |place: usize| command.get(place.saturating_sub(2)..(place + 3).min(command.len()));
    let is_outlier = |place: &usize| {
        let middle = median(around(*place).unwrap_or_default().to_vec());
        command.get(*place).is_some_and(|value| (value - middle).abs() > most)
    };
    let found: Vec<usize> = (0..command.len()).filter(is_outlier).collect();
    if found.len() as f64 > MOST_OUTLIERS * command.len() as f64 { Vec::new() } else { found }
}

/// Omits rows that repeat the row before, and reports times that do not increase.
fn leave_out_repeated(
    table: &MeasuredTable,
    columns: &[(TestSignal, Column)],
    numbers: &ColumnNumbers,
    is_used: &mut [bool],
    findings: &mut Findings,
) {
    let named = columns.iter().zip(&numbers.columns);
    let Some(((_, column), times)) = named.clone().find(|((signal, _), _)| *signal == TestSignal::Time)
    else {
        return;
    };
    let at = |row: usize| named.clone().map(move |(_, values)| values.get(row).map(|value| value.to_bits()));
    let mut repeated = Vec::new();
    let mut before: Option<(usize, f64)> = None;
    for (row, used) in is_used.iter_mut().enumerate().filter(|(_, used)| **used) {
        let time = times.get(row).copied().unwrap_or_default();
        match before {
            Some((last, at_last)) if time == at_last && at(row).eq(at(last)) => {
                repeated.push(row);
                *used = false;
                continue;
            }
            Some((_, at_last)) if time <= at_last => {
                findings.push(not_increasing(table, column, (times, row), findings));
            }
            _ => {}
        }
        before = Some((row, time));
    }
    if !repeated.is_empty() {
        let message = RecordedTestError::Repeated.to_string();
        findings.push(table.warning(&repeated, column, &message, findings));
    }
}

/// Columns over the rows that are used.
pub(super) fn kept(columns: &[(TestSignal, Column)], numbers: ColumnNumbers, is_used: &[bool]) -> Taken {
    let all_used = is_used.iter().all(|used| *used);
    let kept = |mut values: Vec<f64>| {
        if !all_used {
            let mut used = is_used.iter();
            values.retain(|_| used.next().copied().unwrap_or(false));
        }
        values
    };
    let signals = columns.iter().map(|(signal, _)| *signal);
    Taken { columns: signals.zip(numbers.columns.into_iter().map(kept)).collect() }
}
