//! Gauge pressures below the atmosphere.

use super::error::{ColumnError, TableHint};
use super::{Column, MeasuredTable};
use crate::followed::roughness;
use crate::project::{Findings, RawFinding};

/// Gauge pressure of a vacuum, Pa.
const VACUUM: f64 = -101_325.0;
/// Gauge pressure below which a twentieth of a column is, without its noise, if the zero of its
/// transducer is off, Pa.
const ZERO_OFF: f64 = -2e4;

/// Number of standard deviations of the noise by which a single row, and a twentieth of all rows,
/// may be below.
const OF_A_ROW: f64 = 5.0;
const OF_A_TWENTIETH: f64 = 2.0;

impl MeasuredTable {
    /// Rejects a column with pressures below a vacuum by more than its noise, and warns of one that
    /// is below the atmosphere by more than noise. `row` is the row of the table for each value;
    /// NaN is an absent value.
    pub(crate) fn check_gauge(
        &self,
        column: &Column,
        values: &[f64],
        row: impl Fn(usize) -> usize,
        findings: &mut Findings,
    ) {
        let heading = self.heading(column).to_string();
        let read: Vec<f64> = values.iter().copied().filter(|value| !value.is_nan()).collect();
        let noise = roughness(&read);
        let is_impossible = |value: &f64| *value < VACUUM - OF_A_ROW * noise;
        if let Some(first) = values.iter().position(is_impossible) {
            let least = values.iter().copied().fold(f64::INFINITY, f64::min);
            let count = values.iter().filter(|value| is_impossible(value)).count();
            let message = ColumnError::BelowVacuum { heading, least, count, rows: values.len() };
            let found = self.error(row(first), column, message.to_string(), findings);
            let found = found.expected(TableHint::GaugePressureAbove(VACUUM).to_string());
            findings.push(found.help(TableHint::ZeroSignOrUnit.to_string()));
            return;
        }
        let mut sorted = read;
        if sorted.is_empty() {
            return;
        }
        let index = sorted.len() / 20;
        let low = *sorted.select_nth_unstable_by(index, f64::total_cmp).1;
        if low < ZERO_OFF - OF_A_TWENTIETH * noise {
            let count = sorted.iter().filter(|value| **value < 0.0).count();
            let place = self.headings.get(column.index).map(|heading| heading.place).unwrap_or_default();
            let message = ColumnError::BelowAtmosphere { heading, by: -low, count, rows: sorted.len() };
            findings.push(RawFinding::warning(place, message.to_string()));
        }
    }
}
