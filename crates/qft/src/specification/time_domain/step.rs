use num_complex::Complex64;
use phea_dynamics::linear::{TimeDomain, TransferFunction};
use phea_dynamics::minimum;
use phea_dynamics::order::sort_by_number;
use phea_dynamics::portable::{ln, magnitude};
use phea_dynamics::time_response::{Settling, step_response};

use super::TimeDomainError;
use super::check::{Reached, TOLERANCE};

/// Accuracy of the time of an extreme, relative to that between two samples.
const EXTREME_TOLERANCE: f64 = 1e-8;

/// Overshoot and settling time of the unit step response of any stable continuous function,
/// relative to one.
///
/// Samples are spaced by a tenth of a radian of the fastest mode that has not decayed; the peak,
/// and the extremes near the edge of the band, are refined on the exact response, as is the time at
/// which the response finally enters the band. A deviation that equals the band up to rounding is
/// inside.
pub(super) fn reached(function: &TransferFunction, band_percent: f64) -> Result<Reached, TimeDomainError> {
    if function.domain() != TimeDomain::Continuous {
        return Err(TimeDomainError::NotContinuous);
    }
    let response = Response::new(function, band_percent / 100.0)?;
    Ok(Reached { overshoot_percent: 100.0 * response.overshoot()?, settling: response.settling()? })
}

/// A step response without its dead time, sampled.
struct Response {
    function: TransferFunction,
    dead_time_s: f64,
    band: f64,
    /// Time and value, from the step onwards.
    samples: Vec<(f64, f64)>,
}

impl Response {
    fn new(function: &TransferFunction, band: f64) -> Result<Response, TimeDomainError> {
        let dead_time_s = function.dead_time_s();
        let function = function.clone().with_dead_time(0.0)?;
        let times = sample_times(function.poles(), band)?;
        let values = step_response(&function, &times)?;
        let samples = times.into_iter().zip(values).collect();
        Ok(Response { function, dead_time_s, band, samples })
    }

    fn value(&self, time_s: f64) -> f64 {
        // the function had a value at the samples, so it has one at every time
        step_response(&self.function, &[time_s]).map_or(f64::NAN, |values| values.iter().sum())
    }

    /// Overshoot: the excess of the response over one; a rounding error of the response does not
    /// count.
    fn overshoot(&self) -> Result<f64, TimeDomainError> {
        const ROUNDING: f64 = 1e-12;
        let highest =
            |best: usize, index: usize| if self.at(index).1 > self.at(best).1 { index } else { best };
        let peak = (1..self.samples.len()).fold(0, highest);
        let refined = self.extreme_near(peak, 1.0).1;
        let excess = self.at(peak).1.max(refined) - 1.0;
        Ok(if excess > ROUNDING { excess } else { 0.0 })
    }

    fn settling(&self) -> Result<Settling, TimeDomainError> {
        let last = self.samples.len() - 1;
        if self.is_outside(self.at(last).1) {
            return Ok(Settling::NotSettled { deviation_percent: 100.0 * (self.at(last).1 - 1.0).abs() });
        }
        let Some((mut outside, mut inside)) = self.last_exit() else {
            return Ok(Settling::Settled { time_s: self.dead_time_s });
        };
        loop {
            let middle = outside + 0.5 * (inside - outside);
            if middle <= outside || middle >= inside {
                return Ok(Settling::Settled { time_s: self.dead_time_s + inside });
            }
            if self.is_outside(self.value(middle)) { outside = middle } else { inside = middle }
        }
    }

    /// A time outside the band and a later one inside, after which the response stays inside.
    fn last_exit(&self) -> Option<(f64, f64)> {
        (0..self.samples.len() - 1).rev().find_map(|index| {
            let (time, value) = self.at(index);
            let inside = self.at(index + 1).0;
            if self.is_outside(value) {
                return Some((time, inside));
            }
            let size = (value - 1.0).abs();
            let neighbours = [self.at(index.saturating_sub(1)).1, self.at(index + 1).1];
            let near = size > 0.5 * self.band && neighbours.iter().all(|other| (other - 1.0).abs() <= size);
            let (time, value) = near.then(|| self.extreme_near(index, (value - 1.0).signum()))?;
            self.is_outside(value).then_some((time, inside))
        })
    }

    /// The extreme between the neighbours of a sample: a maximum for direction 1, a minimum for -1.
    fn extreme_near(&self, index: usize, direction: f64) -> (f64, f64) {
        let (time, value) = self.at(index);
        let ends = [self.at(index.saturating_sub(1)).0, self.at(index + 1).0];
        let (start, tolerance) = ((time, -direction * value), EXTREME_TOLERANCE * (ends[1] - ends[0]));
        let (time, lowest) = minimum::between(|time| -direction * self.value(time), ends, start, tolerance);
        (time, -direction * lowest)
    }

    fn is_outside(&self, value: f64) -> bool {
        (value - 1.0).abs() > self.band * (1.0 + TOLERANCE)
    }

    /// The sample with this number, or the last one.
    fn at(&self, index: usize) -> (f64, f64) {
        self.samples.get(index).or(self.samples.last()).copied().unwrap_or((0.0, 0.0))
    }
}

/// Times from zero until every mode has decayed far below the band.
fn sample_times(poles: &[Complex64], band: f64) -> Result<Vec<f64>, TimeDomainError> {
    const STEP_RAD: f64 = 0.1;
    const LONGEST: f64 = 300_000.0;
    if let Some(pole) = poles.iter().find(|pole| pole.re >= 0.0) {
        return Err(TimeDomainError::NotStable { real_part: pole.re });
    }
    let life = 20.0 - ln(band);
    let mut modes: Vec<(f64, f64)> =
        poles.iter().map(|pole| (life / -pole.re, STEP_RAD / magnitude(*pole))).collect();
    sort_by_number(&mut modes, |mode| mode.0);
    let damping = poles.iter().map(|pole| -pole.re / magnitude(*pole)).fold(1.0, f64::min);
    let (mut times, mut now) = (vec![0.0], 0.0);
    for (index, &(end, _)) in modes.iter().enumerate() {
        let step = modes.iter().skip(index).map(|mode| mode.1).fold(f64::INFINITY, f64::min);
        let count = ((end - now) / step).ceil();
        if times.len() as f64 + count > LONGEST {
            return Err(TimeDomainError::RingsTooLong { damping_ratio: damping });
        }
        times.extend((1..=count as usize).map(|number| now + (end - now) * (number as f64 / count)));
        now = end;
    }
    Ok(times)
}
