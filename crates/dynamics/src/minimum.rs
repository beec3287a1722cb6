//! Minima of functions of one variable.
//!
//! A point of a function is (x, f(x)); an f(x) that is NaN counts as infinite.

/// Fractions of an interval divided by the golden section, (3 - sqrt(5))/2 and (sqrt(5) - 1)/2.
const SMALLER_PART: f64 = 0.381_966_011_250_105_1;
const LARGER_PART: f64 = 0.618_033_988_749_895;
const STEPS_MAXIMUM: usize = 80;

/// Local minimum between two ends, from a point of the function between them, by Brent's method:
/// parabolas through the last points, golden sections if these fail.
///
/// ```text
/// x <- x + (p d3 - q d2)/(2 (p - q)),   d2 = x2 - x,   d3 = x3 - x,   p = (f(x2) - f(x)) d3,   q = (f(x3) - f(x)) d2
/// ```
///
/// The returned x is within twice the tolerance of a local minimum, found with at most 80 values of
/// f; if f rises on both sides of its least value, it is the global one. The result is never worse
/// than the start. f is evaluated at most a tolerance beyond the ends. Near the minimum f is flat:
/// a tolerance below sqrt(2 e/f''), e being the rounding error of f, gains nothing. Source: Brent
/// 1973, chapter 5.
///
/// # Example
/// x - ln x is least at 1, where it is 1:
/// ```
/// use phea_dynamics::minimum;
///
/// let f = |x: f64| x - x.ln();
/// let (x, least) = minimum::between(f, [0.1, 4.0], (2.0, f(2.0)), 1e-7);
/// assert!((x - 1.0).abs() < 2e-7 && (least - 1.0).abs() < 1e-13);
/// ```
pub fn between(
    mut f: impl FnMut(f64) -> f64,
    ends: [f64; 2],
    start: (f64, f64),
    tolerance: f64,
) -> (f64, f64) {
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
                (longer, SMALLER_PART * longer)
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

/// Step from the best point to the vertex of the parabola through three points.
fn parabola(best: (f64, f64), second: (f64, f64), third: (f64, f64)) -> Option<f64> {
    let (x, y) = (second.0 - best.0, third.0 - best.0);
    let (p, q) = ((second.1 - best.1) * y, (third.1 - best.1) * x);
    let curvature = p - q;
    let offset = (p * y - q * x) / (2.0 * curvature);
    (offset.is_finite() && curvature != 0.0).then_some(offset)
}

/// Local minimum downhill from a point: steps that double until the function rises or reaches an
/// end, then [`between`] the last points.
///
/// # Example
/// From 0 the sine falls to -pi/2:
/// ```
/// use std::f64::consts::FRAC_PI_2;
///
/// use phea_dynamics::minimum;
///
/// let (x, least) = minimum::downhill(f64::sin, [-10.0, 10.0], (0.0, 0.0), 0.1, 1e-7);
/// assert!((x + FRAC_PI_2).abs() < 2e-7 && (least + 1.0).abs() < 1e-13);
/// ```
pub fn downhill(
    mut f: impl FnMut(f64) -> f64,
    ends: [f64; 2],
    start: (f64, f64),
    first_step: f64,
    tolerance: f64,
) -> (f64, f64) {
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

/// Point x between two ends at which a function that falls and then rises is least, by the golden
/// section.
///
/// ```text
/// |x - x*| <= (high - low)/2 * 0.618^steps
/// ```
///
/// Each step takes two values of f, and no starting point is needed; [`between`] takes fewer if a
/// point of the function is known.
///
/// # Example
/// x - ln x is least at 1:
/// ```
/// use phea_dynamics::minimum::golden_section;
///
/// let x = golden_section([0.1, 4.0], 30, |x| x - x.ln());
/// assert!((x - 1.0).abs() < 1.1e-6);
/// ```
pub fn golden_section([mut low, mut high]: [f64; 2], steps: usize, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..steps {
        let [left, right] = [high - LARGER_PART * (high - low), low + LARGER_PART * (high - low)];
        if f(left) < f(right) { high = right } else { low = left }
    }
    f64::midpoint(low, high)
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

    /// The result is the vertex of a parabola within the ends, or the nearer end if the vertex is
    /// beyond them, from either end.
    #[test]
    fn the_least_is_the_vertex_or_an_end() {
        for (vertex, least) in [(0.3, 0.3), (-2.0, -1.0), (5.0, 4.0)] {
            for start in [-1.0, 4.0] {
                let f = |x: f64| (x - vertex) * (x - vertex);
                let found = between(f, [-1.0, 4.0], (start, f(start)), 1e-6);
                assert!((found.0 - least).abs() < 2e-6, "{vertex} from {start}: {found:?}");
            }
            let found = golden_section([-1.0, 4.0], 30, |x| (x - vertex) * (x - vertex));
            // half of 5 times 0.618 to the power of 30, with a factor of two
            assert!((found - least).abs() < 2.7e-6, "{vertex}: {found}");
        }
    }

    #[test]
    fn downhill_finds_a_narrow_valley_far_away_and_stops_at_an_end() {
        let valley = |x: f64| (1e-12 + (x - 5.0) * (x - 5.0)).sqrt();
        let found = downhill(valley, [-100.0, 100.0], (0.0, valley(0.0)), 1e-3, 1e-9);
        assert!((found.0 - 5.0).abs() < 1e-7, "{found:?}");
        assert_eq!(downhill(|x| -x, [0.0, 1.0], (0.5, -0.5), 1e-3, 1e-9).0, 1.0);
    }
}
