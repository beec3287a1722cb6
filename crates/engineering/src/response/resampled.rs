use super::spacing::{FEW_JUMPS, RowSpacing, time_step};
use super::spacing_error::EvenlySampled;
use crate::project::Findings;
use crate::table::{Column, MeasuredTable};

/// Longest time between two rows that a line bridges, in usual steps.
const LONGEST_BRIDGED: f64 = 5.0;
/// Fraction of a turn between two rows up to which a line between them follows a sine within 5 %:
/// (2 pi/10)^2/8.
const TURN: f64 = 0.1;

/// Loss of signals whose rows come early or late.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resampled {
    /// Difference of the deviations of the latest and the earliest row from even spacing, s.
    pub scatter: f64,
    /// Longest time from one row to the next, s.
    pub longest: f64,
}

impl Resampled {
    /// Highest frequency that lines between the rows follow within 5 %, rad/s.
    pub fn highest(&self) -> f64 {
        2.0 * std::f64::consts::PI * TURN / self.longest
    }
}

/// Signals at equal steps.
pub(crate) struct EvenRows {
    /// Step, s.
    pub(crate) step: f64,
    pub(crate) signals: Vec<Vec<f64>>,
    /// Resampling of unevenly recorded rows.
    pub(crate) resampled: Option<Resampled>,
}

/// Signals at equal steps: as recorded if the rows are even, and on lines between them if many are
/// early or late and none is missing. All signals of a row are moved alike, so that the attenuation
/// of a sine by a line is equal in input and output.
pub(crate) fn even_rows(
    table: &MeasuredTable,
    column: &Column,
    times: &[f64],
    signals: Vec<Vec<f64>>,
    findings: &mut Findings,
) -> Option<EvenRows> {
    let spacing = RowSpacing::of(times);
    if !is_software_timed(&spacing, times) || spacing.jumps <= FEW_JUMPS {
        let step = time_step(table, column, times, EvenlySampled::FrequencyResponse, findings)?;
        return Some(EvenRows { step, signals, resampled: None });
    }
    let between = |pair: &[f64]| if let [one, next] = pair { next - one } else { 0.0 };
    let longest = times.windows(2).map(between).fold(0.0, f64::max);
    let signals = signals.iter().map(|values| interpolated(times, values, spacing.step)).collect();
    let resampled = Some(Resampled { scatter: spacing.scatter, longest });
    Some(EvenRows { step: spacing.step, signals, resampled })
}

/// True if rows come late now and then, and none is missing.
pub(crate) fn is_software_timed(spacing: &RowSpacing, times: &[f64]) -> bool {
    let is_bridged = |pair: &[f64]| matches!(pair, [one, next] if next > one && next - one <= LONGEST_BRIDGED * spacing.usual);
    !spacing.is_even() && times.len() > 1 && times.windows(2).all(is_bridged)
}

/// Values at equal intervals, on lines between the rows.
pub(crate) fn interpolated(times: &[f64], values: &[f64], step: f64) -> Vec<f64> {
    let (Some(first), Some(last)) = (times.first(), times.last()) else { return Vec::new() };
    if values.is_empty() {
        return Vec::new();
    }
    let mut row = 0;
    let count = ((last - first) / step + 1e-9).floor() as usize + 1;
    let at = |index: usize| {
        let time = first + index as f64 * step;
        while times.get(row + 1).is_some_and(|next| *next < time) {
            row += 1;
        }
        let of = |numbers: &[f64], row: usize| numbers.get(row).copied().unwrap_or(f64::NAN);
        let (from, to) = (of(times, row), of(times, row + 1));
        let fraction = if to > from { (time - from) / (to - from) } else { 0.0 };
        let value = of(values, row);
        if fraction == 0.0 { value } else { value + fraction * (of(values, row + 1) - value) }
    };
    (0..count).map(at).collect()
}
