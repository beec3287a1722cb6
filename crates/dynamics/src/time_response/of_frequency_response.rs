use std::f64::consts::PI;

use crate::portable::{cos, sin};

/// Unit step response of a stable system that is known by its frequency response alone, at 0, h, 2
/// h, ...
///
/// ```text
/// g(t) = (2/pi) integral of Re T(j w) cos(w t) over w = 0 .. infinity,     y(t) = integral of g
/// sampled:  g(k) = (2 h/pi) integral of Re T cos(w k h) over w = 0 .. pi/h,   g(0) half of that,   y(k) = sum of g
/// ```
///
/// `real_parts` are increasing frequencies in rad/s with Re T there, straight between two of them,
/// constant below the first and zero beyond the last; `step_s` is h in s, which must be short
/// against whatever the response does. The integral over frequency is exact, that over time is
/// Simpson's.
///
/// # Example
/// A lag of 0.1 s
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
    let impulse = |time_s: f64| 2.0 / PI * cosine_integral(real_parts, time_s);
    let mut response = Vec::with_capacity(count);
    if is_sampled {
        let mut sum = -0.5 * step_s * impulse(0.0);
        for sample in 0..count {
            sum += step_s * impulse(sample as f64 * step_s);
            response.push(sum);
        }
        return response;
    }
    let (mut sum, mut before) = (0.0, impulse(0.0));
    for sample in 0..count {
        response.push(sum);
        let [middle, after] = [0.5, 1.0].map(|part| impulse((sample as f64 + part) * step_s));
        sum += step_s / 6.0 * (before + 4.0 * middle + after);
        before = after;
    }
    response
}

/// Integral of R(w) cos(w t), R straight between its points.
///
/// ```text
/// of (r + q (w - a)) cos(w t) from a to b = [(r + q (w - a)) sin(w t)/t + q cos(w t)/t^2]
/// ```
fn cosine_integral(points: &[(f64, f64)], time: f64) -> f64 {
    let (Some(&(first, at_first)), Some(&(last, at_last))) = (points.first(), points.last()) else {
        return 0.0;
    };
    if time == 0.0 {
        let pieces = points.windows(2).map(|pair| 0.5 * (pair[1].0 - pair[0].0) * (pair[0].1 + pair[1].1));
        return first * at_first + pieces.sum::<f64>();
    }
    let mut sum = at_last * sin(last * time) / time;
    let mut before = cos(first * time);
    for pair in points.windows(2) {
        let slope = (pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0);
        let after = cos(pair[1].0 * time);
        sum += slope * (after - before) / (time * time);
        before = after;
    }
    sum
}

#[cfg(test)]
mod tests {
    use num_complex::Complex64;

    use super::*;
    use crate::portable::{exp, exp_complex};

    /// A resonance of 20 rad/s behind a dead time of 30 ms: its closed form, late. Straight lines
    /// over 0.1 rad/s miss it by up to 8e-5, and the corner with which it begins costs Simpson 400
    /// h^2/12 = 3e-5.
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
