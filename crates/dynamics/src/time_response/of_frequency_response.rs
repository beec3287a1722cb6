use std::f64::consts::PI;

use super::cosine_sums::{Cosine, sums_of_cosines};
use crate::portable::sin;

/// Unit step response of a stable system that is known only by its frequency response, at 0, h, 2
/// h, ...
///
/// ```text
/// g(t) = (2/pi) integral of Re T(j w) cos(w t) over w = 0 .. infinity,     y(t) = integral of g
/// sampled:  g(k) = (2 h/pi) integral of Re T cos(w k h) over w = 0 .. pi/h,   g(0) half of that,   y(k) = sum of g
/// ```
///
/// `real_parts` are increasing frequencies in rad/s with Re T there, linear between them, constant
/// below the first and zero beyond the last; `step_s` is h in s, which must be short compared with
/// any feature of the response. The integral over frequency is exact; that over time uses Simpson's
/// rule.
///
/// # Example
/// A lag of 0.1 s:
/// ```
/// use phea_dynamics::portable::exp;
/// use phea_dynamics::time_response::step_of_frequency_response;
/// let lag = |frequency: f64| 1.0 / (1.0 + (0.1 * frequency).powi(2)); // Re 1/(1 + 0.1 j w)
/// let points: Vec<(f64, f64)> = (0..6000).map(|k| 0.05 * 1.003_f64.powi(k)).map(|w| (w, lag(w))).collect();
/// let response = step_of_frequency_response(&points, 1e-3, 500, false);
/// assert!((0..500).all(|k| (response[k] - (1.0 - exp(-0.01 * k as f64))).abs() < 1e-4));
/// ```
pub fn step_of_frequency_response(
    real_parts: &[(f64, f64)],
    step_s: f64,
    count: usize,
    is_sampled: bool,
) -> Vec<f64> {
    let at_zero = integral(real_parts);
    let mut response = Vec::with_capacity(count);
    if is_sampled {
        let mut sum = -0.5 * step_s * at_zero;
        let later = cosine_integrals(real_parts, step_s, count.saturating_sub(1));
        for impulse in std::iter::once(at_zero).chain(later).take(count) {
            sum += step_s * impulse;
            response.push(sum);
        }
        return response;
    }
    let (mut sum, mut before) = (0.0, at_zero);
    for pair in cosine_integrals(real_parts, 0.5 * step_s, 2 * count).chunks_exact(2) {
        let &[middle, after] = pair else { continue };
        response.push(sum);
        sum += step_s / 6.0 * (before + 4.0 * middle + after);
        before = after;
    }
    response
}

/// Weights g(k) of the convolution y(k) = sum of g(i) u(k - i) of a stable system that is known
/// only by its frequency response H: that of a sampled system over its whole band, or of a
/// continuous one whose response vanishes beyond its last point, by the trapezoidal rule.
///
/// ```text
/// g(k) = (2 h/pi) integral of Re H cos(w k h) over w,     g(0) half of that
/// ```
///
/// Arguments `real_parts` and `step_s` are those of [`step_of_frequency_response`].
///
/// # Example
/// y(k) = 0.5 y(k - 1) + u(k)
/// ```
/// use phea_dynamics::time_response::weights_of_frequency_response;
/// let step_s = 0.01;
/// let end = std::f64::consts::PI / step_s;
/// let real_part = |w: f64| { let c = (w * step_s).cos(); (1.0 - 0.5 * c) / (1.25 - c) };
/// let points: Vec<(f64, f64)> = (0..=2000).map(|k| f64::from(k) * end / 2000.0).map(|w| (w, real_part(w))).collect();
/// let weights = weights_of_frequency_response(&points, step_s, 10);
/// assert!((0..10).all(|k| (weights[k] - 0.5_f64.powi(k as i32)).abs() < 1e-5));
/// ```
pub fn weights_of_frequency_response(real_parts: &[(f64, f64)], step_s: f64, count: usize) -> Vec<f64> {
    let later = cosine_integrals(real_parts, step_s, count.saturating_sub(1));
    let first = 0.5 * integral(real_parts);
    std::iter::once(first).chain(later).take(count).map(|impulse| step_s * impulse).collect()
}

/// 2/pi times the integral of R(w), linear between its points.
fn integral(points: &[(f64, f64)]) -> f64 {
    let pieces = points.windows(2).map(|pair| 0.5 * (pair[1].0 - pair[0].0) * (pair[0].1 + pair[1].1));
    let below = points.first().map_or(0.0, |(first, value)| first * value);
    2.0 / PI * (below + pieces.sum::<f64>())
}

/// 2/pi times the integral of R(w) cos(w t) at t = h, 2 h, ..., with R linear between its points.
///
/// ```text
/// of (r + q (w - a)) cos(w t) from a to b = [(r + q (w - a)) sin(w t)/t + q cos(w t)/t^2]
/// sum of the pieces = R(w_n) sin(w_n t)/t + sum of (q before - q after) cos(w t)/t^2 over the points
/// ```
fn cosine_integrals(points: &[(f64, f64)], step_s: f64, count: usize) -> Vec<f64> {
    let slope = |pair: &[(f64, f64)]| (pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0);
    let slopes: Vec<f64> = points.windows(2).map(slope).collect();
    let before = std::iter::once(&0.0).chain(&slopes);
    let bends = before.zip(slopes.iter().chain([&0.0])).map(|(before, after)| before - after);
    let terms: Vec<Cosine> = points
        .iter()
        .zip(bends)
        .map(|((frequency, _), weight)| Cosine { frequency_rad_per_s: *frequency, weight })
        .collect();
    let last = points.last().copied().unwrap_or_default();
    let sums = sums_of_cosines(&terms, step_s, count).into_iter().enumerate();
    sums.map(|(index, sum)| {
        let time = (index + 1) as f64 * step_s;
        2.0 / PI * (last.1 * sin(last.0 * time) + sum / time) / time
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use num_complex::Complex64;

    use super::*;
    use crate::portable::{cos, exp, exp_complex};

    /// A resonance of 20 rad/s with a dead time of 30 ms: its closed form, delayed. Straight lines
    /// over 0.1 rad/s deviate by up to 8e-5, and the initial corner contributes 400 h^2/12 = 3e-5
    /// by Simpson's rule.
    #[test]
    fn a_resonance_behind_dead_time() {
        let (own, damping, late) = (20.0_f64, 0.1_f64, 0.03);
        let response = |w: f64| {
            let s = Complex64::new(0.0, w);
            own * own / (s * s + 2.0 * damping * own * s + own * own) * exp_complex(-s * late)
        };
        let points: Vec<(f64, f64)> =
            (0..30_000).map(|k| f64::from(k) * 0.1).map(|w| (w, response(w).re)).collect();
        let turning = own * (1.0 - damping * damping).sqrt();
        for (k, found) in step_of_frequency_response(&points, 1e-3, 1000, false).into_iter().enumerate() {
            let t = k as f64 * 1e-3 - late;
            let decay = exp(-damping * own * t);
            // ORIGIN: analytic, the step response of a system of second order
            let exact = 1.0 - decay * (cos(turning * t) + damping * own / turning * sin(turning * t));
            let exact = if t > 0.0 { exact } else { 0.0 };
            assert!((found - exact).abs() < 2e-4, "{found} {exact} at {t} s");
        }
    }

    /// The closed form of each piece.
    #[test]
    fn integrals_are_those_of_their_pieces() {
        let points: Vec<(f64, f64)> =
            (0..3000).map(|k| f64::from(k) * 1.3).map(|w| (w, 1.0 / (1.0 + w * w / 9e4))).collect();
        for (index, found) in cosine_integrals(&points, 5e-4, 200).into_iter().enumerate() {
            let time = (index + 1) as f64 * 5e-4;
            let piece = |pair: &[(f64, f64)]| {
                let [(from, at_from), (to, at_to)] = [pair[0], pair[1]];
                let slope = (at_to - at_from) / (to - from);
                (at_to * sin(to * time) - at_from * sin(from * time)) / time
                    + slope * (cos(to * time) - cos(from * time)) / (time * time)
            };
            // ORIGIN: analytic, the integral over each straight piece
            let expected = 2.0 / PI * points.windows(2).map(piece).sum::<f64>();
            assert!((found - expected).abs() < 1e-9 * integral(&points), "{found} {expected} at {time} s");
        }
    }

    /// y(k + 1) = 0.9 y(k) + 0.1 u(k)
    #[test]
    fn a_sampled_lag() {
        let step_s = 0.01;
        let response = |w: f64| 0.1 / (exp_complex(Complex64::new(0.0, w * step_s)) - 0.9);
        let points: Vec<(f64, f64)> = (0..=20_000)
            .map(|k| f64::from(k) / 20_000.0 * PI / step_s)
            .map(|w| (w, response(w).re))
            .collect();
        let mut exact = 0.0;
        for found in step_of_frequency_response(&points, step_s, 60, true) {
            assert!((found - exact).abs() < 1e-5, "{found} {exact}");
            exact = 0.9 * exact + 0.1;
        }
    }
}
