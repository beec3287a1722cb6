//! Characteristics of a step response.

use super::{ResponseCount, ResponseNumber, TimeResponseError};
use crate::range::RequiredRange;

/// Step against which a response is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepBaseline {
    /// Time of the step, s.
    pub step_time_s: f64,
    /// Value before the step.
    pub initial_value: f64,
    /// Target value of the response: its difference from the initial value is 100 percent.
    pub final_value: f64,
}

impl StepBaseline {
    /// Baseline from zero to one at time zero.
    pub fn unit() -> Self {
        StepBaseline { step_time_s: 0.0, initial_value: 0.0, final_value: 1.0 }
    }

    /// Baseline from zero to this value at time zero, as the final value of a unit step response is
    /// the gain at zero frequency.
    pub fn to_value(final_value: f64) -> Self {
        StepBaseline { step_time_s: 0.0, initial_value: 0.0, final_value }
    }
}

/// Settling of the response in its band.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Settling {
    /// The response enters the band permanently.
    Settled {
        /// Time after the step, s.
        time_s: f64,
    },
    /// The last sample is outside the band.
    NotSettled {
        /// Deviation of the last sample from the final value, percent of the step.
        deviation_percent: f64,
    },
}

impl Settling {
    /// Settling time in s, if there is one.
    pub fn time_s(self) -> Option<f64> {
        match self {
            Settling::Settled { time_s } => Some(time_s),
            Settling::NotSettled { .. } => None,
        }
    }
}

/// Characteristics of a step response. All times count from the step; crossings are interpolated
/// between samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepMetrics {
    /// Rise time from 10 to 90 percent of the step, s; `None` if the response never gets there.
    pub rise_time_10_90_s: Option<f64>,
    /// Extreme value in the direction of the step.
    pub peak_value: f64,
    /// Time of the first peak value, s.
    pub peak_time_s: f64,
    /// Excess of the peak over the final value, percent of the step; zero without overshoot.
    pub overshoot_percent: f64,
    /// Settling of the response in the band.
    pub settling: Settling,
    /// Band of the settling time: plus or minus this percentage of the step.
    pub settling_band_percent: f64,
}

/// Characteristics of the samples of a step response, for an explicit baseline and settling band.
///
/// # Errors
/// [`TimeResponseError::Count`] when times and values differ in number or none is after the step,
/// [`TimeResponseError::TimeOrder`], [`TimeResponseError::NoStep`],
/// [`TimeResponseError::OutOfRange`] for a band that is not between 0 and 100 percent or a value
/// that is not finite.
///
/// # Example
/// ```
/// use phea_dynamics::time_response::{Settling, StepBaseline, step_metrics};
/// let times = [0.0, 1.0, 2.0, 3.0, 4.0];
/// let values = [0.0, 1.0, 1.5, 1.0, 1.0];
/// let metrics = step_metrics(&times, &values, StepBaseline::unit(), 5.0)?;
/// assert_eq!((metrics.overshoot_percent, metrics.peak_time_s), (50.0, 2.0));
/// assert_eq!(metrics.rise_time_10_90_s, Some(0.8));
/// assert!(metrics.settling.time_s().is_some_and(|time| (time - 2.9).abs() < 1e-15));
/// # Ok::<(), phea_dynamics::time_response::TimeResponseError>(())
/// ```
pub fn step_metrics(
    times_s: &[f64],
    values: &[f64],
    baseline: StepBaseline,
    settling_band_percent: f64,
) -> Result<StepMetrics, TimeResponseError> {
    let step = baseline.final_value - baseline.initial_value;
    check(times_s, values, baseline, settling_band_percent)?;
    // progress: 0 before, 1 at the final value
    let after_step = times_s.iter().zip(values).filter(|(time, _)| **time >= baseline.step_time_s);
    let samples: Vec<(f64, f64)> = after_step
        .clone()
        .map(|(time, value)| (time - baseline.step_time_s, (value - baseline.initial_value) / step))
        .collect();
    let (Some(&first), Some(&last)) = (samples.first(), samples.last()) else {
        return Err(TimeResponseError::Count {
            what: ResponseCount::SamplesAfterStep,
            found: 0,
            expected: 1,
        });
    };
    let higher = |best: (f64, f64, f64), (sample, value): (&(f64, f64), f64)| {
        if sample.1 > best.1 { (sample.0, sample.1, value) } else { best }
    };
    let values_after = after_step.map(|(_, value)| *value);
    let start = (first.0, f64::NEG_INFINITY, baseline.initial_value);
    let (peak_time_s, peak, peak_value) = samples.iter().zip(values_after).fold(start, higher);
    let rise_10_90 = first_reach(&samples, 0.1).zip(first_reach(&samples, 0.9)).map(|(low, high)| high - low);
    let settling = match settling_time(&samples, settling_band_percent / 100.0) {
        Some(time_s) => Settling::Settled { time_s },
        None => Settling::NotSettled { deviation_percent: 100.0 * (last.1 - 1.0).abs() },
    };
    Ok(StepMetrics {
        rise_time_10_90_s: rise_10_90,
        peak_value,
        peak_time_s,
        overshoot_percent: (100.0 * (peak - 1.0)).max(0.0),
        settling,
        settling_band_percent,
    })
}

fn check(
    times_s: &[f64],
    values: &[f64],
    baseline: StepBaseline,
    settling_band_percent: f64,
) -> Result<(), TimeResponseError> {
    if times_s.len() != values.len() {
        let (found, expected) = (values.len(), times_s.len());
        return Err(TimeResponseError::Count { what: ResponseCount::ResponseValues, found, expected });
    }
    let mut last = f64::NEG_INFINITY;
    for (index, &time_s) in times_s.iter().enumerate() {
        if !(time_s.is_finite() && time_s >= last) {
            return Err(TimeResponseError::TimeOrder { index, time_s });
        }
        last = time_s;
    }
    let numbers = [baseline.step_time_s, baseline.initial_value, baseline.final_value];
    if let Some(&value) = values.iter().chain(&numbers).find(|value| !value.is_finite()) {
        return Err(TimeResponseError::OutOfRange {
            what: ResponseNumber::ResponseValue,
            value,
            expected: RequiredRange::Finite,
        });
    }
    if !(settling_band_percent > 0.0 && settling_band_percent < 100.0) {
        return Err(TimeResponseError::OutOfRange {
            what: ResponseNumber::SettlingBand,
            value: settling_band_percent,
            expected: RequiredRange::BetweenZeroAndHundred,
        });
    }
    if baseline.final_value == baseline.initial_value {
        return Err(TimeResponseError::NoStep { value: baseline.final_value });
    }
    Ok(())
}

/// Time at which the progress first reaches a level, interpolated.
fn first_reach(samples: &[(f64, f64)], level: f64) -> Option<f64> {
    let index = samples.iter().position(|sample| sample.1 >= level)?;
    let after = samples[index];
    match index.checked_sub(1).map(|before| samples[before]) {
        Some(before) => Some(between(before, after, level)),
        None => Some(after.0),
    }
}

/// Time at which the last sample outside the band crosses into it, interpolated; `None` if the last
/// sample is outside.
fn settling_time(samples: &[(f64, f64)], band: f64) -> Option<f64> {
    // a deviation that equals the band within rounding is inside
    let outside = |sample: &(f64, f64)| (sample.1 - 1.0).abs() > band * (1.0 + 1e-12);
    let Some(index) = samples.iter().rposition(outside) else {
        return samples.first().map(|sample| sample.0);
    };
    let (before, after) = (samples[index], *samples.get(index + 1)?);
    let level = if before.1 > 1.0 { 1.0 + band } else { 1.0 - band };
    Some(between(before, after, level))
}

fn between(before: (f64, f64), after: (f64, f64), level: f64) -> f64 {
    let fraction = (level - before.1) / (after.1 - before.1);
    before.0 + fraction.clamp(0.0, 1.0) * (after.0 - before.0)
}
