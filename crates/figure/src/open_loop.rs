//! Frequency response as a curve of phase and magnitude.

use num_complex::Complex64;
use phea_dynamics::portable::{argument, log10};

use super::axis::{Axis, extent};
use super::bode::{FrequencySeries, decibel, unwrapped_degrees};
use super::ticks::TickSteps;

/// Response with unwrapped phase, mostly between -360 and 0 degrees.
pub(super) struct UnwrappedResponse {
    frequencies: Vec<f64>,
    /// Points (phase in degrees, magnitude in dB).
    pub(super) points: Vec<(f64, f64)>,
}

/// Phase in degrees on the turn nearest to `near`.
pub(super) fn phase_near(response: Complex64, near: f64) -> f64 {
    let principal = argument(response).to_degrees();
    principal + 360.0 * ((near - principal) / 360.0).round()
}

/// Axis that covers the finite values with a small margin, its ends on multiples of 10 dB.
pub(super) fn decibel_axis(title: &str, values: impl IntoIterator<Item = f64>) -> Axis {
    const ROOM: f64 = 2.0;
    let (low, high) = extent(values.into_iter().filter(|v| v.is_finite()));
    let (low, high) = (10.0 * ((low - ROOM) / 10.0).floor(), 10.0 * ((high + ROOM) / 10.0).ceil());
    Axis { steps: TickSteps::Decibel, ..Axis::linear(title, low, high) }
}

impl UnwrappedResponse {
    pub(super) fn new(series: &FrequencySeries) -> UnwrappedResponse {
        let degrees = unwrapped_degrees(&series.response, None);
        let inside = |turns: i32| {
            let shifted = degrees.iter().map(|phase| phase + 360.0 * f64::from(turns));
            shifted.filter(|phase| (-360.0..=0.0).contains(phase)).count()
        };
        // turn with most points, the least shift among equals
        let turns = [0, -1, 1].into_iter().rev().max_by_key(|turns| inside(*turns)).unwrap_or(0);
        let points = degrees
            .iter()
            .zip(&series.response)
            .map(|(phase, response)| (phase + 360.0 * f64::from(turns), decibel(*response)))
            .collect();
        UnwrappedResponse { frequencies: series.frequencies_rad_per_s.clone(), points }
    }

    /// Phase and magnitude at a frequency, interpolated by the logarithm of frequency; `None`
    /// outside its range.
    pub(super) fn at(&self, frequency: f64) -> Option<(f64, f64)> {
        let next = self.frequencies.iter().position(|other| *other >= frequency)?;
        let (high, above) = (*self.frequencies.get(next)?, *self.points.get(next)?);
        if high == frequency {
            return Some(above);
        }
        let (low, below) = (*self.frequencies.get(next.checked_sub(1)?)?, *self.points.get(next - 1)?);
        let part = log10(frequency / low) / log10(high / low);
        let between = |a: f64, b: f64| a + part * (b - a);
        Some((between(below.0, above.0), between(below.1, above.1)))
    }
}
