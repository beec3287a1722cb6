//! Minima of functions of one variable.

/// Golden section of an interval, as a share of its longer part.
const GOLDEN: f64 = 0.381_966_011_250_105_1;
const STEPS_MAXIMUM: usize = 80;

/// A point and the value there.
pub(crate) type At = (f64, f64);

/// A local minimum between two ends, from a point between them: parabolas through the last points,
/// golden sections where they fail (Brent 1973, chapter 5). NaN counts as infinite.
pub(crate) fn between<F: FnMut(f64) -> f64>(mut f: F, ends: [f64; 2], start: At, tolerance: f64) -> At {
    let [mut low, mut high] = ends;
    let (mut best, mut second, mut third) = (start, start, start);
    let (mut step, mut before_last): (f64, f64) = (0.0, 0.0);
    for _ in 0..STEPS_MAXIMUM {
        let middle = (low + high) / 2.0;
        if (best.0 - middle).abs() + (high - low) / 2.0 <= 2.0 * tolerance {
            break;
        }
        let parabolic = parabola(best, second, third).filter(|offset| {
            let to = best.0 + offset;
            offset.abs() < before_last.abs() / 2.0 && low < to && to < high
        });
        (before_last, step) = match parabolic {
            Some(offset) => (step, offset),
            None => {
                let longer = if best.0 < middle { high - best.0 } else { low - best.0 };
                (longer, GOLDEN * longer)
            }
        };
        let moved = if step.abs() >= tolerance { step } else { tolerance.copysign(step) };
        let at = best.0 + moved;
        let value = f(at);
        if value <= best.1 {
            (low, high) = if at < best.0 { (low, best.0) } else { (best.0, high) };
            (best, second, third) = ((at, value), best, second);
        } else {
            (low, high) = if at < best.0 { (at, high) } else { (low, at) };
            if value <= second.1 || second.0 == best.0 {
                (second, third) = ((at, value), second);
            } else if value <= third.1 || third.0 == best.0 || third.0 == second.0 {
                third = (at, value);
            }
        }
    }
    best
}

/// From the best point to the vertex of the parabola through three.
fn parabola(best: At, second: At, third: At) -> Option<f64> {
    let (x, y) = (second.0 - best.0, third.0 - best.0);
    let (p, q) = ((second.1 - best.1) * y, (third.1 - best.1) * x);
    let curvature = p - q;
    let offset = (p * y - q * x) / (2.0 * curvature);
    (offset.is_finite() && curvature != 0.0).then_some(offset)
}

/// Downhill from a point, in steps that double, until the function rises or an end is met; then the
/// minimum between.
pub(super) fn downhill<F: FnMut(f64) -> f64>(
    mut f: F,
    ends: [f64; 2],
    start: At,
    first_step: f64,
    tolerance: f64,
) -> At {
    let clamped = |x: f64| x.max(ends[0]).min(ends[1]);
    let mut at = |x: f64| (x, f(x));
    let (right, left) = (at(clamped(start.0 + first_step)), at(clamped(start.0 - first_step)));
    let (mut behind, mut here, mut ahead) = match (right.1 < start.1, left.1 < start.1) {
        (false, false) => return between(f, [left.0, right.0], start, tolerance),
        (true, false) => (left, start, right),
        (false, true) => (right, start, left),
        (true, true) if right.1 < left.1 => (left, start, right),
        (true, true) => (right, start, left),
    };
    while ahead.1 < here.1 {
        let next = clamped(ahead.0 + 2.0 * (ahead.0 - here.0));
        if next == ahead.0 {
            return ahead;
        }
        (behind, here, ahead) = (here, ahead, at(next));
    }
    between(f, [behind.0.min(ahead.0), behind.0.max(ahead.0)], here, tolerance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_met_at_once_and_a_corner_by_sections() {
        let mut count = 0;
        let smooth = |x: f64| {
            count += 1;
            (x - 0.3) * (x - 0.3)
        };
        let found = between(smooth, [-1.0, 2.0], (0.0, 0.09), 1e-8);
        assert!((found.0 - 0.3).abs() < 1e-7 && count < 12, "{found:?} {count}");
        let found = between(|x: f64| (x - 0.3).abs(), [-1.0, 2.0], (0.0, 0.3), 1e-8);
        assert!((found.0 - 0.3).abs() < 1e-7);
    }

    #[test]
    fn downhill_finds_a_narrow_valley_far_away_and_stops_at_an_end() {
        let valley = |x: f64| (1e-12 + (x - 5.0) * (x - 5.0)).sqrt();
        let found = downhill(valley, [-100.0, 100.0], (0.0, valley(0.0)), 1e-3, 1e-9);
        assert!((found.0 - 5.0).abs() < 1e-7, "{found:?}");
        assert_eq!(downhill(|x| -x, [0.0, 1.0], (0.5, -0.5), 1e-3, 1e-9).0, 1.0);
    }
}
