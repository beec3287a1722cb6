//! Input signals given by samples.

use super::{ResponseCount, ResponseNumber, TimeResponseError};
use crate::range::RequiredRange;

/// Interpolation of an input between two samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// The earlier value is held.
    Hold,
    /// Linear interpolation to the later value.
    Linear,
}

/// Input in time: zero before its first sample, constant after its last.
///
/// # Example
/// ```
/// use phea_dynamics::time_response::{Interpolation, SampledSignal};
/// # fn main() -> Result<(), phea_dynamics::time_response::TimeResponseError> {
/// let ramp = SampledSignal::new(vec![1.0, 3.0], vec![0.0, 4.0], Interpolation::Linear)?;
/// assert_eq!([0.0, 2.0, 9.0].map(|time| ramp.value_at(time)), [0.0, 2.0, 4.0]);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SampledSignal {
    times_s: Vec<f64>,
    values: Vec<f64>,
    interpolation: Interpolation,
}

impl SampledSignal {
    /// Signal through these samples; times in s, strictly rising.
    ///
    /// # Errors
    /// [`TimeResponseError::Count`], [`TimeResponseError::TimeOrder`],
    /// [`TimeResponseError::OutOfRange`] for a value that is not finite.
    pub fn new(
        times_s: Vec<f64>,
        values: Vec<f64>,
        interpolation: Interpolation,
    ) -> Result<Self, TimeResponseError> {
        if times_s.len() != values.len() {
            let (found, expected) = (values.len(), times_s.len());
            return Err(TimeResponseError::Count { what: ResponseCount::SignalValues, found, expected });
        }
        let mut last = f64::NEG_INFINITY;
        for (index, &time_s) in times_s.iter().enumerate() {
            if !(time_s.is_finite() && time_s > last) {
                return Err(TimeResponseError::TimeOrder { index, time_s });
            }
            last = time_s;
        }
        if let Some(&value) = values.iter().find(|value| !value.is_finite()) {
            return Err(TimeResponseError::OutOfRange {
                what: ResponseNumber::SignalValue,
                value,
                expected: RequiredRange::Finite,
            });
        }
        Ok(SampledSignal { times_s, values, interpolation })
    }

    /// Step of this height at time zero.
    pub fn step(height: f64) -> Self {
        SampledSignal { times_s: vec![0.0], values: vec![height], interpolation: Interpolation::Hold }
    }

    /// Signal delayed by a dead time in s.
    pub fn delayed(&self, dead_time_s: f64) -> Self {
        let times_s = self.times_s.iter().map(|time| time + dead_time_s).collect();
        SampledSignal { times_s, values: self.values.clone(), interpolation: self.interpolation }
    }

    /// Value at a time in s; at a jump, the value after it.
    pub fn value_at(&self, time_s: f64) -> f64 {
        let (value, slope, from) = self.piece_at(time_s);
        value + slope * (time_s - from)
    }

    /// Sample times in s.
    pub fn times_s(&self) -> &[f64] {
        &self.times_s
    }

    /// Value, slope and start of the piece in force at a time, the later piece at a sample.
    pub(super) fn piece_at(&self, time_s: f64) -> (f64, f64, f64) {
        let after = self.times_s.partition_point(|&sample| sample <= time_s);
        let Some(index) = after.checked_sub(1) else { return (0.0, 0.0, time_s) };
        let (from, value) = (self.times_s[index], self.values[index]);
        let slope = match (self.interpolation, self.times_s.get(after), self.values.get(after)) {
            (Interpolation::Linear, Some(&to), Some(&next)) => (next - value) / (to - from),
            _ => 0.0,
        };
        (value, slope, from)
    }
}

/// Equally spaced times from zero to `duration_s`; their number is `points`.
///
/// # Errors
/// [`TimeResponseError::OutOfRange`] when the duration is not positive and finite.
///
/// # Example
/// ```
/// let times = phea_dynamics::time_response::uniform_times(1.0, 5)?;
/// assert_eq!(times, [0.0, 0.25, 0.5, 0.75, 1.0]);
/// # Ok::<(), phea_dynamics::time_response::TimeResponseError>(())
/// ```
pub fn uniform_times(duration_s: f64, points: usize) -> Result<Vec<f64>, TimeResponseError> {
    if !(duration_s.is_finite() && duration_s > 0.0) {
        return Err(TimeResponseError::OutOfRange {
            what: ResponseNumber::Duration,
            value: duration_s,
            expected: RequiredRange::PositiveAndFinite,
        });
    }
    let last = points.saturating_sub(1).max(1) as f64;
    Ok((0..points).map(|index| duration_s * (index as f64 / last)).collect())
}
