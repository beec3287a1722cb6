use phea_dynamics::order::ends;

use super::spacing_error::{EvenlySampled, SpacingError, SpacingHint};
use crate::project::{Findings, RawFinding};
use crate::table::{Column, MeasuredTable, median_step};

/// Deviation of a row from even spacing, as a fraction of the time between rows, that is permitted.
pub const UNEVEN: f64 = 0.1;

/// Fewest rows that give information about a frequency.
const FEWEST_ROWS: usize = 32;

/// Time between rows, s. Rows that are early or late by more than [`UNEVEN`] of it are rejected,
/// unless their stamps are rounded to no more than that: calculations assume evenly spaced samples.
pub fn time_step(
    table: &MeasuredTable,
    column: &Column,
    times: &[f64],
    sampled: EvenlySampled,
    findings: &mut Findings,
) -> Option<f64> {
    let place = table.header_place();
    if times.len() < FEWEST_ROWS {
        let message = SpacingError::TooFewRows { rows: times.len(), sampled };
        let found = RawFinding::error(place, message.to_string());
        findings.push(found.expected(SpacingHint::AtLeastRows(FEWEST_ROWS).to_string()));
        return None;
    }
    let spacing = RowSpacing::of(times);
    if spacing.is_even() {
        return Some(spacing.step);
    }
    let usual = spacing.usual;
    // the row at which the usual step ends, rather than the one with the largest sum of deviations
    let off = |pair: &[f64]| match pair {
        [one, next] => ((next - one) - usual).abs(),
        _ => 0.0,
    };
    let most = times.windows(2).map(off).fold(0.0, f64::max);
    let rounded = ((1.0 + ROUNDING) * spacing.digit).max(UNEVEN * usual);
    // a row that is late is early for the row after it, by an equal amount except for rounding
    // errors
    let beyond = rounded.min((1.0 - 1e-6) * most);
    let row = times.windows(2).position(|pair| off(pair) > beyond).map_or(0, |row| row + 1);
    let since =
        times.get(row).zip(times.get(row.saturating_sub(1))).map_or(0.0, |(one, before)| one - before);
    let found = table.error(row, column, SpacingError::After(since).to_string(), findings);
    let found = found.expected(SpacingHint::Apart(usual).to_string());
    findings.push(found.help(SpacingHint::ClockOfSampling.to_string()));
    None
}

/// Spacing of the rows of a record in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RowSpacing {
    /// Slope of the line through all stamps, s.
    pub step: f64,
    /// Usual difference from one row to the next, s.
    pub usual: f64,
    /// Last digit of the stamps, s.
    pub digit: f64,
    /// Difference of the deviations of the latest and the earliest row from that line, s.
    pub scatter: f64,
    /// Fraction of the rows whose difference from the row before is not the usual one.
    pub jumps: f64,
}

/// Fraction of the last digit by which even rows may scatter in addition to their rounding.
const ROUNDING: f64 = 0.05;
/// Fraction of rows below which an unusual difference means a missing row.
pub(super) const FEW_JUMPS: f64 = 0.02;

impl RowSpacing {
    /// Spacing of these stamps, s.
    pub fn of(times: &[f64]) -> RowSpacing {
        let first = times.first().copied().unwrap_or(0.0);
        let middle = times.len().saturating_sub(1) as f64 / 2.0;
        let since: Vec<f64> = times.iter().map(|time| time - first).collect();
        let mean = since.iter().sum::<f64>() / times.len().max(1) as f64;
        let [mut along, mut squares] = [0.0; 2];
        for (row, time) in since.iter().enumerate() {
            let from_middle = row as f64 - middle;
            along += from_middle * (time - mean);
            squares += from_middle * from_middle;
        }
        let step = if squares > 0.0 { along / squares } else { 0.0 };
        let off = since.iter().enumerate().map(|(row, time)| time - row as f64 * step);
        let [least, most] = ends(off);
        let usual = median_step(times);
        let is_jump = |pair: &&[f64]| matches!(pair, [one, next] if ((next - one) - usual).abs() > UNEVEN * usual.abs());
        let jumps = times.windows(2).filter(is_jump).count() as f64 / times.len().max(1) as f64;
        RowSpacing { step, usual, digit: last_digit(times), scatter: most - least, jumps }
    }

    /// True if the rows are as even as the digits of their stamps show. Rounding moves many rows;
    /// if few are moved, rows are missing.
    pub fn is_even(&self) -> bool {
        let is_rounded = self.jumps > FEW_JUMPS;
        let rounded = if is_rounded { (1.0 + ROUNDING) * self.digit } else { 0.0 };
        self.step > 0.0 && self.scatter <= rounded.max(2.0 * UNEVEN * self.step)
    }
}

/// Decimal of which all these times are multiples, at most 1 s.
fn last_digit(times: &[f64]) -> f64 {
    let is_multiple = |digit: &f64| {
        let off = |time: &f64| (time / digit - (time / digit).round()).abs();
        times.iter().all(|time| off(time) < 1e-4 * (1.0 + 1e-9 * (time / digit).abs()))
    };
    [1.0, 0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7].into_iter().find(is_multiple).unwrap_or(0.0)
}
