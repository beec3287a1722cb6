//! The critical delay of a sampled loop, with its plant resampled for each delay.
//!
//! Phase over frequency at the crossovers of the sampled L equals that delay if it is a whole
//! number of samples. Between whole samples a delay also changes |L|: for k/s with k T = 1.25 this
//! gives 0.66 samples instead of the true 0.8. Each time the loop is resampled, closer to its
//! limit, the error of the estimated remaining delay decreases.
//!
//! If a rate or an inner signal is fed back within the plant, the remaining delay is that of the
//! controller's path, and resampling the plant would also delay the rate: phase over frequency is
//! used instead. [`borne_delay`] is the search for any estimate of the remaining delay, such as
//! that of the whole loop, cut at the command.

use phea_dynamics::uncertain_plant::PlantCoefficients;

use super::characteristic::FeedbackPath;
use super::{CriticalDelay, StabilityStatus, of_member};
use crate::closed_loop::{Compensation, moved_rate};

/// The remaining delay, as a fraction of the total, at which the search stops.
const TOLERANCE: f64 = 1e-9;
/// Number of steps of the search, and then of bisection.
const STEPS_MAXIMUM: usize = 60;

/// Critical delay; `None` for a loop that is initially unstable, and if a rate or an inner signal
/// is fed back within the plant.
pub(super) fn critical_delay(
    plant: &PlantCoefficients<f64>,
    compensation: &Compensation,
    path: &FeedbackPath,
) -> Option<CriticalDelay> {
    let rate = compensation.rate_feed_forward() != 0.0 && moved_rate(plant).is_some();
    if rate || compensation.inner_feedback().is_some() {
        return None;
    }
    let remaining = |delay_s: f64| {
        let delayed = compensation.with_delay(compensation.delay_s() + delay_s);
        let found = of_member(&delayed.member(plant.clone()).ok()?, &delayed, path);
        found.critical_delay.filter(|_| found.status == StabilityStatus::Stable)
    };
    borne_delay(&remaining)
}

/// The delay at which a loop becomes unstable, from an estimate of the remainder after each delay,
/// s, which is `None` if the loop is unstable; `None` for a loop that is initially unstable.
///
/// # Example
/// Loop that tolerates 3 s, with an estimate that is a fifth too long.
/// ```
/// use phea_qft::stability::{CriticalDelay, borne_delay};
/// let remaining = |delay_s: f64| {
///     let rest_s = 3.0 - delay_s;
///     (rest_s > 0.0).then_some(CriticalDelay { delay_s: 1.2 * rest_s, frequency_rad_per_s: 5.0 })
/// };
/// assert!((borne_delay(&remaining).unwrap().delay_s - 3.0).abs() < 1e-6);
/// ```
pub fn borne_delay(remaining: &dyn Fn(f64) -> Option<CriticalDelay>) -> Option<CriticalDelay> {
    let mut rest = remaining(0.0)?;
    let mut borne = 0.0;
    let mut too_long = f64::INFINITY;
    for _ in 0..STEPS_MAXIMUM {
        let estimate = borne + rest.delay_s;
        let next = if estimate < too_long { estimate } else { 0.5 * (borne + too_long) };
        let open = (next - borne).min(too_long - borne);
        if next.is_infinite() || open <= TOLERANCE * next {
            break;
        }
        match remaining(next) {
            Some(found) => (borne, rest) = (next, found),
            None => too_long = next,
        }
    }
    let delay_s = (borne + rest.delay_s).min(too_long);
    Some(CriticalDelay { delay_s, frequency_rad_per_s: rest.frequency_rad_per_s })
}
