//! Rows whose times do not increase.

use super::error::{RowError, TableHint};
use super::{Column, MeasuredTable};
use crate::project::{Findings, RawFinding};

/// Median of all differences from one row to the next, in the unit of the times.
pub(crate) fn median_step(times: &[f64]) -> f64 {
    let mut steps: Vec<f64> =
        times.windows(2).filter_map(|pair| Some(pair.last()? - pair.first()?)).collect();
    let middle = steps.len() / 2;
    if steps.is_empty() {
        return 0.0;
    }
    *steps.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Error for a row whose time is not after that of the row before, at the wrong one of both.
pub(crate) fn not_increasing(
    table: &MeasuredTable,
    column: &Column,
    (times, row): (&[f64], usize),
    findings: &Findings,
) -> RawFinding {
    let wrong = misplaced(times, row);
    let is_equal = row.checked_sub(1).and_then(|before| times.get(before)) == times.get(row);
    let message = match (is_equal, wrong < row) {
        (true, _) => RowError::SameTime,
        (false, true) => RowError::NotBeforeNext,
        (false, false) => RowError::BeforePrevious,
    };
    let remedy = match is_equal {
        true => TableHint::AllDigitsOfTimes,
        false => TableHint::SortByTime,
    };
    let found = table.error(if is_equal { row } else { wrong }, column, message.to_string(), findings);
    found.expected(TableHint::IncreasingTimes.to_string()).help(remedy.to_string())
}

/// Number of rows to either side whose usual step counts.
const NEAR: usize = 20;

/// Wrong one of two rows whose times do not increase: the earlier one if it is further from one
/// usual step after the row before both than the later one is from two.
fn misplaced(times: &[f64], row: usize) -> usize {
    let at = |back: usize| row.checked_sub(back).and_then(|row| times.get(row)).copied();
    let Some(((two_before, before), now)) = at(2).zip(at(1)).zip(at(0)) else { return row };
    let near = times.get(row.saturating_sub(NEAR)..times.len().min(row + NEAR)).unwrap_or_default();
    let usual = median_step(near);
    let off = |time: f64, steps: f64| (time - two_before - steps * usual).abs();
    if off(now, 2.0) < off(before, 1.0) { row - 1 } else { row }
}
