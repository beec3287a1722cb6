//! 95 % intervals by linearisation, also for coefficients that may vanish.

use phea_dynamics::least_squares::{Linearised, Settings, Uncertainty, uncertainty_with_shared};
use phea_dynamics::portable;
use phea_hydraulics::servovalve::StaticCoefficients;

use super::SignalFit;
use super::recording::{Recording, SignalKind};
use super::variables::{COUNT, Kind, TARE_FLOW, Variables, over};
use crate::estimate::{Estimate, NORMAL_95};

/// Half width, in changes that matter, beyond which an interval carries no information: a factor of
/// a million.
const NOTHING_SAID: f64 = 14.0;

/// Uncertainty of the coefficients, in changes that matter, see [`Variables::scales`].
pub(super) fn uncertainty(
    at: &Linearised,
    groups: &[usize],
    shared: &[Vec<f64>],
    variables: &Variables,
    coefficients: &StaticCoefficients,
) -> Uncertainty {
    let scales = variables.scales(coefficients);
    let slopes = variables.slopes(coefficients);
    let mut factors = scales;
    for (factor, slope) in factors.iter_mut().zip(slopes) {
        *factor = over(*factor, slope);
    }
    let mut at = at.clone();
    for row in at.jacobian.chunks_exact_mut(COUNT) {
        for (slope, factor) in row.iter_mut().zip(factors) {
            *slope *= factor;
        }
    }
    uncertainty_with_shared(&at, groups, COUNT, Settings::default().robust_beyond, shared)
}

/// 1.4826 times the median distance of the magnitude of normal noise from its fitted value, divided
/// by the standard deviation of the noise: 0.65 from the mean, 0.63 from the centre of the robust
/// loss.
const OF_MAGNITUDE: f64 = 0.62;

/// Reduces the interval of the tare flow by the amount that a meter without direction may have
/// added to it.
///
/// The mean over rows of such a meter without flow is that of the magnitude of its noise:
///
/// ```text
/// E|q + n| = sigma sqrt(2/pi) exp(-q^2/(2 sigma^2)) + q erf(q/(sqrt 2 sigma))
/// ```
///
/// The least tare flow is that for which the meter would show the interval's lower end. The noise
/// is taken from the scale of the residuals as if all of them were magnitudes, which is its upper
/// bound.
pub(super) fn lowered_tare_flow(
    estimates: &mut [Option<Estimate>; COUNT],
    recordings: &[Recording],
    signals: &[SignalFit],
) {
    let is_unsigned = |fit: &&SignalFit| {
        let signal = recordings.get(fit.recording).and_then(|one| one.signal(SignalKind::LeakFlow));
        signal.is_some_and(|signal| signal.values.iter().flatten().all(|value| *value >= 0.0))
    };
    let of_leakage = signals.iter().filter(|fit| fit.kind == SignalKind::LeakFlow).filter(is_unsigned);
    let noise = of_leakage.map(|fit| fit.scale / OF_MAGNITUDE).fold(0.0, f64::max);
    if let Some(Some(Estimate { interval: [low, _], .. })) = estimates.get_mut(TARE_FLOW) {
        *low = without_magnitude(*low, noise);
    }
}

/// Flow for which a meter without direction shows this value in the mean.
fn without_magnitude(shown: f64, noise: f64) -> f64 {
    let mean = |flow: f64| {
        let relative = flow / noise;
        let of_noise = (2.0 / std::f64::consts::PI).sqrt() * portable::exp(-0.5 * relative * relative);
        noise * of_noise + flow * (1.0 - portable::erfc(relative / std::f64::consts::SQRT_2))
    };
    if noise <= 0.0 {
        return shown;
    }
    let [mut low, mut high] = [0.0, shown];
    while high - low > 1e-6 * noise {
        let middle = f64::midpoint(low, high);
        if mean(middle) < shown { low = middle } else { high = middle }
    }
    if low > 0.0 { high } else { 0.0 }
}

/// Standard deviation of each coefficient in its unit; infinite if nothing depends on it.
pub(super) fn deviations(
    variables: &Variables,
    coefficients: &StaticCoefficients,
    relative: &[f64],
) -> [f64; COUNT] {
    let mut deviations = variables.scales(coefficients);
    for (scale, deviation) in deviations.iter_mut().zip(relative) {
        *scale = if deviation.is_finite() { *scale * deviation } else { f64::INFINITY };
    }
    deviations
}

/// Each coefficient with its interval, from its standard deviation divided by the change that
/// matters.
///
/// For a positive coefficient both ends are positive. For one that may vanish the negative part of
/// the interval is cut off: if its lower end is zero, the interval is an upper bound.
pub(super) fn estimates(
    variables: &Variables,
    coefficients: &StaticCoefficients,
    deviations: &[f64],
) -> [Option<Estimate>; COUNT] {
    let scales = variables.scales(coefficients);
    let mut found = [None; COUNT];
    let all = found.iter_mut().zip(coefficients.to_array()).zip(scales).zip(deviations);
    for (index, (((found, value), scale), deviation)) in all.enumerate() {
        let half = NORMAL_95 * deviation;
        let interval = [-half, half].map(|by| match Kind::of(index) {
            Kind::Positive => value * portable::exp(by),
            Kind::MayVanish => (value + by * scale).max(0.0),
            Kind::EitherSign | Kind::InSeries => value + by * scale,
        });
        *found = (half < NOTHING_SAID).then_some(Estimate { value, interval });
    }
    found
}
