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
    let mut impulse = CosineIntegrals::new(real_parts);
    let mut response = Vec::with_capacity(count);
    if is_sampled {
        let mut sum = -0.5 * step_s * impulse.at_zero();
        impulse.step_by(step_s);
        for sample in 0..count {
            sum += step_s * if sample == 0 { impulse.at_zero() } else { impulse.next() };
            response.push(sum);
        }
        return response;
    }
    let (mut sum, mut before) = (0.0, impulse.at_zero());
    impulse.step_by(0.5 * step_s);
    for _ in 0..count {
        response.push(sum);
        let (middle, after) = (impulse.next(), impulse.next());
        sum += step_s / 6.0 * (before + 4.0 * middle + after);
        before = after;
    }
    response
}

/// Steps after which cosines are computed anew: rounding adds up in between.
const STEPS_BETWEEN: usize = 32;

/// 2/pi times the integral of R(w) cos(w t) at one time after another, R straight between its
/// points.
///
/// ```text
/// of (r + q (w - a)) cos(w t) from a to b = [(r + q (w - a)) sin(w t)/t + q cos(w t)/t^2]
/// e^(j w (t + h)) = e^(j w t) e^(j w h)
/// ```
struct CosineIntegrals<'a> {
    points: &'a [(f64, f64)],
    /// q between each point and the next.
    slopes: Vec<f64>,
    step_s: f64,
    steps: usize,
    /// cos(w t) and sin(w t) of each point.
    turned: Vec<[f64; 2]>,
    /// The same of one step.
    turns: Vec<[f64; 2]>,
}

impl CosineIntegrals<'_> {
    fn new(points: &[(f64, f64)]) -> CosineIntegrals<'_> {
        let slope = |pair: &[(f64, f64)]| (pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0);
        let slopes = points.windows(2).map(slope).collect();
        CosineIntegrals { points, slopes, step_s: 0.0, steps: 0, turned: vec![], turns: vec![] }
    }

    fn at_zero(&self) -> f64 {
        let pieces =
            self.points.windows(2).map(|pair| 0.5 * (pair[1].0 - pair[0].0) * (pair[0].1 + pair[1].1));
        let below = self.points.first().map_or(0.0, |(first, value)| first * value);
        2.0 / PI * (below + pieces.sum::<f64>())
    }

    /// What [`CosineIntegrals::next`] adds to the time, which is zero.
    fn step_by(&mut self, step_s: f64) {
        (self.step_s, self.steps) = (step_s, 0);
        self.turns = self.at(step_s);
    }

    fn at(&self, time: f64) -> Vec<[f64; 2]> {
        self.points.iter().map(|(frequency, _)| [cos(frequency * time), sin(frequency * time)]).collect()
    }

    /// The integral one step later.
    fn next(&mut self) -> f64 {
        self.steps += 1;
        let time = self.steps as f64 * self.step_s;
        if self.steps % STEPS_BETWEEN == 1 {
            self.turned = self.at(time);
        } else {
            for ([cosine, sine], [cosine_of_step, sine_of_step]) in self.turned.iter_mut().zip(&self.turns) {
                let before = *cosine;
                *cosine = before * cosine_of_step - *sine * sine_of_step;
                *sine = *sine * cosine_of_step + before * sine_of_step;
            }
        }
        let ends = self.points.last().zip(self.turned.last());
        let at_last = ends.map_or(0.0, |((_, value), [_, sine])| value * sine / time);
        let between = self.turned.windows(2).zip(&self.slopes);
        let pieces = between.map(|(pair, slope)| slope * (pair[1][0] - pair[0][0]));
        2.0 / PI * (at_last + pieces.sum::<f64>() / (time * time))
    }
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

    /// The closed form of each piece, by cosines of their own, over more steps than go without.
    #[test]
    fn integrals_are_those_of_cosines_of_their_own() {
        let points: Vec<(f64, f64)> =
            (0..3000).map(|k| f64::from(k) * 1.3).map(|w| (w, 1.0 / (1.0 + w * w / 9e4))).collect();
        let mut integrals = CosineIntegrals::new(&points);
        integrals.step_by(5e-4);
        for step in 1..=5 * STEPS_BETWEEN {
            let time = step as f64 * 5e-4;
            let piece = |pair: &[(f64, f64)]| {
                let [(from, at_from), (to, at_to)] = [pair[0], pair[1]];
                let slope = (at_to - at_from) / (to - from);
                (at_to * sin(to * time) - at_from * sin(from * time)) / time
                    + slope * (cos(to * time) - cos(from * time)) / (time * time)
            };
            // ORIGIN: analytic, the integral over each straight piece
            let expected = 2.0 / PI * points.windows(2).map(piece).sum::<f64>();
            let found = integrals.next();
            assert!((found - expected).abs() < 1e-9 * integrals.at_zero(), "{found} {expected} at {time} s");
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
