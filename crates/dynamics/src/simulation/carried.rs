//! Small error propagated along a run: growth where no single mode grows.
//!
//! Each interval between two kinks may be stable, but the run unstable: a mass that bounces off a
//! wall loses less of an error on its way back than it gains at the wall. Eigenvalues do not show
//! this; the derivative of the whole run does.

use super::{Amplification, GrowthCause, Lane};
use crate::{portable, random};

/// Size beyond which an error is scaled back, so that it stays finite.
const LARGE: f64 = 1e6;

/// Error of each lane, in the units of its states.
///
/// ```text
/// e -> R(h J) e                         over a step: Rosenbrock::carry
/// e -> e + s,  s_i = +-scale_i          if it has not grown
/// growth = |e|/|e_1|,  |e| the root mean square of e_i/scale_i
/// ```
///
/// e_1 is e a step after the last s, or s if that is larger: by then the error has spread over
/// states that are stiffly coupled.
#[derive(Clone, Debug)]
pub(super) struct CarriedErrors<S> {
    error: Vec<S>,
    /// Error at the end of the step.
    pub(super) next: Vec<S>,
    lanes: Vec<CarriedLane>,
}

/// Growth of the error in a lane.
#[derive(Clone, Copy, Debug, Default)]
struct CarriedLane {
    /// State of the random numbers from which the signs are drawn.
    chance: u64,
    from_s: f64,
    /// Logarithm of the factor by which the error was scaled back.
    scaled: f64,
    /// Logarithm of the error one step after its last renewal; `None` within that step.
    first: Option<f64>,
    largest: Option<Amplification>,
}

impl<S: Lane> CarriedErrors<S> {
    pub(super) fn new(states: usize) -> CarriedErrors<S> {
        let none = vec![S::from(0.0); states];
        CarriedErrors { error: none.clone(), next: none, lanes: vec![CarriedLane::default(); S::COUNT] }
    }

    /// Resets a lane.
    pub(super) fn forget(&mut self, lane: usize) {
        self.lanes[lane] = CarriedLane::default();
        self.error.iter_mut().for_each(|error| error.set_lane(lane, 0.0));
    }

    /// Sets the error at the start of a step, to be propagated to its end.
    pub(super) fn begin(&mut self) {
        self.next.copy_from_slice(&self.error);
    }

    /// Accepts the error at the end of a step taken in a lane, at this time in s.
    pub(super) fn take(&mut self, lane: usize, time_s: f64, scales: &[S]) {
        let Some(own) = self.lanes.get_mut(lane) else { return };
        let mut sum = 0.0;
        for ((error, next), scale) in self.error.iter_mut().zip(&self.next).zip(scales) {
            error.set_lane(lane, next.lane(lane));
            let part = next.lane(lane) / scale.lane(lane);
            sum += part * part;
        }
        let size = (sum / scales.len().max(1) as f64).sqrt();
        let now = own.scaled + portable::ln(size);
        let Some(first) = own.first else {
            own.first = Some(now.max(0.0));
            return;
        };
        let logarithm = now - first;
        if logarithm > own.largest.map_or(0.0, |largest| largest.logarithm) {
            let CarriedLane { from_s, .. } = *own;
            let cause = GrowthCause::Motion;
            let (until_s, frequency_rad_per_s) = (time_s, 0.0);
            own.largest = Some(Amplification { logarithm, from_s, until_s, frequency_rad_per_s, cause });
        }
        if logarithm.is_nan() || logarithm <= 0.0 {
            self.renew(lane, time_s, scales);
        } else if size > LARGE {
            own.scaled += portable::ln(LARGE);
            let scaled = |error: &mut S| error.set_lane(lane, error.lane(lane) / LARGE);
            self.error.iter_mut().for_each(scaled);
        }
    }

    /// Adds a new error to the remaining previous one.
    fn renew(&mut self, lane: usize, time_s: f64, scales: &[S]) {
        let Some(own) = self.lanes.get_mut(lane) else { return };
        for (error, scale) in self.error.iter_mut().zip(scales) {
            let sign = if random::uniform(&mut own.chance) < 0.5 { -1.0 } else { 1.0 };
            let left = Some(error.lane(lane)).filter(|left| left.is_finite() && own.scaled == 0.0);
            error.set_lane(lane, left.unwrap_or(0.0) + sign * scale.lane(lane));
        }
        (own.from_s, own.first, own.scaled) = (time_s, None, 0.0);
    }

    /// Largest growth of the error in a lane.
    pub(super) fn amplification(&self, lane: usize) -> Option<Amplification> {
        self.lanes.get(lane).and_then(|own| own.largest)
    }
}

/// Number of factors of the fraction by which an error is propagated over a step.
pub(super) const CARRIED: usize = 6;

/// Weights b_k of [`Rosenbrock::carry`](super::rosenbrock::Rosenbrock::carry), from the
/// coefficients p_j of P.
///
/// ```text
/// p_j = sum over i of C(6, i) (-gamma)^i/(j - i)!,    z^j w^6 = (w - 1)^j w^(6 - j)/gamma^j
/// ```
pub(super) fn carried_weights(gamma: f64) -> [f64; CARRIED] {
    let ratio = |numerator: usize, denominator: usize| numerator as f64 / denominator as f64;
    let choose = |of: usize, some: usize| (0..some).fold(1.0, |all, i| all * ratio(of - i, i + 1));
    let factorial = |of: usize| (1..=of).fold(1.0, |all, i| all * i as f64);
    let power = |base: f64, exponent: usize| (0..exponent).fold(1.0, |all, _| all * base);
    let mut weights = [0.0; CARRIED];
    for j in 0..CARRIED {
        let terms = (0..=j).map(|i| choose(CARRIED, i) * power(-gamma, i) / factorial(j - i));
        let coefficient = terms.sum::<f64>() / power(gamma, j);
        for m in 0..=j {
            weights[m + CARRIED - j - 1] += coefficient * choose(j, m) * power(-1.0, j - m);
        }
    }
    weights
}

#[cfg(test)]
mod tests {
    use num_complex::Complex64;

    use super::*;

    /// The weights are those of the exponential to the order of the method, and form an L-stable
    /// fraction: |R| is at most 1 on the imaginary axis, and vanishes at infinity.
    #[test]
    fn errors_are_carried_by_the_exponential() {
        let gamma = 0.21193756319429014;
        let weights = carried_weights(gamma);
        let carried = |z: Complex64| {
            let w = 1.0 / (1.0 - gamma * z);
            weights.iter().rev().fold(Complex64::default(), |sum, weight| (sum + weight) * w)
        };
        for angle in [0.02, 0.1, 0.5] {
            let z = Complex64::new(-0.3 * angle, angle);
            let exact = Complex64::new(portable::cos(angle), portable::sin(angle)) * portable::exp(z.re);
            let error = portable::magnitude(carried(z) - exact);
            assert!(error < 2e-3 * portable::pow(angle, 6.0), "{angle}");
        }
        for exponent in 0..60 {
            let angle = portable::pow(10.0, 0.1 * f64::from(exponent) - 2.0);
            let left = portable::magnitude(carried(Complex64::new(0.0, angle)));
            assert!(left <= 1.0 + 1e-14, "{angle}");
        }
        assert!(portable::magnitude(carried(Complex64::new(-1e9, 0.0))) < 1e-7);
    }
}
