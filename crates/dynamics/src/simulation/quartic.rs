use super::method::Extension;
use crate::order::sort_numbers;

/// Halvings that find a root to the last bit of a fraction of a step.
const HALVINGS: usize = 60;

/// Signal over one step: a polynomial of degree four in the fraction of the step, from 0 to 1.
///
/// ```text
/// p(theta) = c_0 + c_1 theta + c_2 theta^2 + c_3 theta^3 + c_4 theta^4
/// ```
///
/// # Example
/// The maximum of theta (1 - theta) is a quarter, in the middle of the step:
/// ```
/// use phea_dynamics::simulation::Quartic;
/// let hump = Quartic([0.0, 1.0, -1.0, 0.0, 0.0]);
/// let [lowest, highest] = hump.extremes([0.0, 1.0]);
/// assert!(lowest == 0.0 && (highest - 0.25).abs() < 1e-15);
/// let [at_least, at_most] = hump.bounds();
/// assert!(at_least <= lowest && highest <= at_most && at_most <= 0.5);
/// assert!((hump.first_above(0.09, [0.0, 1.0]).unwrap() - 0.1).abs() < 1e-12);
/// assert!((hump.last_above(0.09, [0.0, 1.0]).unwrap() - 0.9).abs() < 1e-12);
/// assert!((hump.mean([0.0, 1.0]) - 1.0 / 6.0).abs() < 1e-15);
/// assert!((hump.mean_square([0.0, 1.0]) - 1.0 / 30.0).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quartic(pub [f64; 5]);

impl Quartic {
    /// Constant signal.
    pub fn constant(value: f64) -> Quartic {
        Quartic([value, 0.0, 0.0, 0.0, 0.0])
    }

    pub(super) fn of(extension: &Extension<f64>) -> Quartic {
        let Extension { start, end, coefficients: [first, second, third] } = extension;
        Quartic([*start, end - start + first, second - first, third - second, -third])
    }

    /// Polynomial through five values at 0, 1/4, 1/2, 3/4 and 1.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::simulation::Quartic;
    /// let cube = Quartic::through([0.0, 1.0 / 64.0, 0.125, 27.0 / 64.0, 1.0]);
    /// assert!((cube.at(0.3) - 0.027).abs() < 1e-15);
    /// ```
    pub fn through([f0, f1, f2, f3, f4]: [f64; 5]) -> Quartic {
        Quartic([
            f0,
            (-25.0 * f0 + 48.0 * f1 - 36.0 * f2 + 16.0 * f3 - 3.0 * f4) / 3.0,
            (70.0 * f0 - 208.0 * f1 + 228.0 * f2 - 112.0 * f3 + 22.0 * f4) / 3.0,
            (-80.0 * f0 + 288.0 * f1 - 384.0 * f2 + 224.0 * f3 - 48.0 * f4) / 3.0,
            (32.0 * f0 - 128.0 * f1 + 192.0 * f2 - 128.0 * f3 + 32.0 * f4) / 3.0,
        ])
    }

    /// Sum with another polynomial times a factor.
    #[inline]
    pub fn plus(self, factor: f64, other: &Quartic) -> Quartic {
        let mut sum = self;
        for (one, other) in sum.0.iter_mut().zip(&other.0) {
            *one += factor * other;
        }
        sum
    }

    /// Value at a fraction of the step.
    #[inline]
    pub fn at(&self, part: f64) -> f64 {
        let [c0, c1, c2, c3, c4] = self.0;
        c0 + part * (c1 + part * (c2 + part * (c3 + part * c4)))
    }

    fn slope(&self, part: f64) -> f64 {
        let [_, c1, c2, c3, c4] = self.0;
        c1 + part * (2.0 * c2 + part * (3.0 * c3 + part * 4.0 * c4))
    }

    /// Bernstein coefficients, whose least and greatest bound the polynomial.
    #[inline]
    fn hull(&self) -> [f64; 5] {
        let [c0, c1, c2, c3, c4] = self.0;
        [
            c0,
            c0 + 0.25 * c1,
            c0 + 0.5 * c1 + c2 / 6.0,
            c0 + 0.75 * c1 + 0.5 * c2 + 0.25 * c3,
            c0 + c1 + c2 + c3 + c4,
        ]
    }

    /// Bounds over the whole step, at little cost.
    #[inline]
    pub fn bounds(&self) -> [f64; 2] {
        let [first, others @ ..] = self.hull();
        others.iter().fold([first; 2], |[low, high], value| [low.min(*value), high.max(*value)])
    }

    /// True if a test of little cost shows that it only rises or only falls.
    #[inline]
    pub fn is_plainly_monotone(&self) -> bool {
        let [b0, b1, b2, b3, b4] = self.hull();
        (b0 <= b1 && b1 <= b2 && b2 <= b3 && b3 <= b4) || (b0 >= b1 && b1 >= b2 && b2 >= b3 && b3 >= b4)
    }

    /// Least and greatest value between two fractions of the step.
    pub fn extremes(&self, [from, until]: [f64; 2]) -> [f64; 2] {
        let (first, last) = (self.at(from), self.at(until));
        let ends = [first.min(last), first.max(last)];
        if self.is_plainly_monotone() {
            return ends;
        }
        let within = self.turning_points().into_iter().filter(|part| from < *part && *part < until);
        within.map(|part| self.at(part)).fold(ends, |[low, high], value| [low.min(value), high.max(value)])
    }

    /// First fraction of the step from `from` to `until` at which it is not below a level.
    pub fn first_above(&self, level: f64, [from, until]: [f64; 2]) -> Option<f64> {
        if self.at(from) >= level {
            return Some(from);
        }
        let mut before = from;
        for after in self.pieces([from, until]) {
            if self.at(after) >= level {
                return Some(self.crossing(level, [before, after]));
            }
            before = after;
        }
        None
    }

    /// Last fraction of the step from `from` to `until` at which it is above a level.
    pub fn last_above(&self, level: f64, [from, until]: [f64; 2]) -> Option<f64> {
        if self.at(until) > level {
            return Some(until);
        }
        let mut after = until;
        let mut ends = vec![from];
        ends.extend(self.pieces([from, until]));
        ends.pop();
        for before in ends.into_iter().rev() {
            if self.at(before) > level {
                return Some(self.crossing(level, [before, after]));
            }
            after = before;
        }
        None
    }

    /// Mean between two fractions of the step.
    pub fn mean(&self, span: [f64; 2]) -> f64 {
        gauss(span, |part| self.at(part))
    }

    /// Mean square between two fractions of the step.
    pub fn mean_square(&self, span: [f64; 2]) -> f64 {
        gauss(span, |part| self.at(part) * self.at(part))
    }

    /// Mean square between two fractions of the step of a signal that is limited to plus and minus
    /// a limit.
    pub fn mean_square_within(&self, limit: f64, [from, until]: [f64; 2]) -> f64 {
        let [low, high] = self.bounds();
        if -limit <= low && high <= limit {
            return self.mean_square([from, until]);
        }
        let mut ends = vec![from];
        for turning in self.pieces([from, until]) {
            let before = ends.last().copied().unwrap_or(from);
            let crosses = |level: f64| (self.at(before) - level) * (self.at(turning) - level) < 0.0;
            let levels = [-limit, limit].into_iter().filter(|level| crosses(*level));
            let mut between: Vec<f64> = levels.map(|level| self.crossing(level, [before, turning])).collect();
            sort_numbers(&mut between);
            ends.extend(between);
            ends.push(turning);
        }
        let of = |span: &[f64]| match *span {
            [start, end] if self.at(0.5 * (start + end)).abs() > limit => (end - start) * limit * limit,
            [start, end] => (end - start) * self.mean_square([start, end]),
            _ => 0.0,
        };
        ends.windows(2).map(of).sum::<f64>() / (until - from)
    }

    /// Ends of the intervals, from `from` to `until`, over each of which it rises or falls.
    fn pieces(&self, [from, until]: [f64; 2]) -> impl Iterator<Item = f64> {
        let turning = if self.is_plainly_monotone() { Vec::new() } else { self.turning_points() };
        turning.into_iter().filter(move |part| from < *part && *part < until).chain(std::iter::once(until))
    }

    /// Fraction at which it crosses a level, between two fractions on either side of it between
    /// which it rises or falls.
    fn crossing(&self, level: f64, [mut one, mut other]: [f64; 2]) -> f64 {
        let above = self.at(one) >= level;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (one + other);
            if (self.at(middle) >= level) == above {
                one = middle;
            } else {
                other = middle;
            }
        }
        other
    }

    /// Fractions in the step at which its slope vanishes, in order: between the zeros of its
    /// curvature.
    fn turning_points(&self) -> Vec<f64> {
        let [_, _, c2, c3, c4] = self.0;
        let mut ends = vec![0.0];
        ends.extend(roots_within([2.0 * c2, 6.0 * c3, 12.0 * c4]));
        ends.push(1.0);
        let mut found = Vec::new();
        for pair in ends.windows(2) {
            let [mut one, mut other] = [pair[0], pair[1]];
            let rising = self.slope(one) > 0.0;
            if rising == (self.slope(other) > 0.0) {
                continue;
            }
            for _ in 0..HALVINGS {
                let middle = 0.5 * (one + other);
                if (self.slope(middle) > 0.0) == rising {
                    one = middle;
                } else {
                    other = middle;
                }
            }
            found.push(other);
        }
        found
    }
}

/// Roots between 0 and 1 of c_0 + c_1 x + c_2 x^2, in order.
fn roots_within([c0, c1, c2]: [f64; 3]) -> Vec<f64> {
    let square = c1 * c1 - 4.0 * c2 * c0;
    if square < 0.0 {
        return Vec::new();
    }
    let sum = -0.5 * (c1 + square.sqrt().copysign(c1));
    let mut roots: Vec<f64> =
        [sum / c2, c0 / sum].into_iter().filter(|root| *root > 0.0 && *root < 1.0).collect();
    sort_numbers(&mut roots);
    roots
}

/// Distances from the middle in half spans, and weights: the five-point Gauss rule, exact to degree
/// nine.
// ORIGIN: analytic, roots of Legendre's polynomial of degree five
const POINTS: [(f64, f64); 2] =
    [(0.538_469_310_105_683_1, 0.239_314_335_249_683_24), (0.906_179_845_938_664, 0.118_463_442_528_094_54)];

/// Weight of the middle.
const MIDDLE: f64 = 64.0 / 225.0;

/// Points between 0 and 1 and their weights in a mean: the five-point Gauss rule, exact to degree
/// nine.
///
/// # Example
/// The mean of x^9 over the unit interval is a tenth:
/// ```
/// let mean: f64 = phea_dynamics::simulation::gauss_points().map(|(x, weight)| weight * x.powi(9)).iter().sum();
/// assert!((mean - 0.1).abs() < 1e-15);
/// ```
pub fn gauss_points() -> [(f64, f64); 5] {
    let [(inner, inner_weight), (outer, outer_weight)] = POINTS;
    let at = |place: f64, weight: f64| (0.5 + 0.5 * place, weight);
    [
        at(-outer, outer_weight),
        at(-inner, inner_weight),
        at(0.0, MIDDLE),
        at(inner, inner_weight),
        at(outer, outer_weight),
    ]
}

/// Mean over an interval by the Gauss rule.
#[inline]
fn gauss([from, until]: [f64; 2], value: impl Fn(f64) -> f64) -> f64 {
    let (middle, half) = (0.5 * (from + until), 0.5 * (until - from));
    POINTS.iter().fold(MIDDLE * value(middle), |sum, (place, weight)| {
        sum + weight * (value(middle - half * place) + value(middle + half * place))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random;

    /// Signals of every shape agree with ten thousand sampled points.
    #[test]
    fn extremes_crossings_and_means_are_those_of_many_places() {
        let mut stream = 7;
        for _ in 0..500 {
            let signal = Quartic(std::array::from_fn(|_| random::normal(&mut stream)));
            let span = [0.3 * random::uniform(&mut stream), 1.0 - 0.3 * random::uniform(&mut stream)];
            let places = (0..=10_000).map(|place| span[0] + (span[1] - span[0]) * f64::from(place) / 1e4);
            let values: Vec<(f64, f64)> = places.map(|part| (part, signal.at(part))).collect();
            let [low, high] = signal.extremes(span);
            let fold =
                |of: fn(f64, f64) -> f64, first| values.iter().fold(first, |one, value| of(one, value.1));
            let seen = [fold(f64::min, f64::INFINITY), fold(f64::max, f64::NEG_INFINITY)];
            assert!((-1e-12..1e-6).contains(&(seen[0] - low)), "{signal:?} {span:?}");
            assert!((-1e-12..1e-6).contains(&(high - seen[1])), "{signal:?} {span:?}");
            let [at_least, at_most] = signal.bounds();
            assert!(at_least <= low && high <= at_most);
            let level = random::normal(&mut stream);
            let first = values.iter().find(|value| value.1 >= level).map(|value| value.0);
            let last = values.iter().rev().find(|value| value.1 > level).map(|value| value.0);
            for (found, seen) in
                [(signal.first_above(level, span), first), (signal.last_above(level, span), last)]
            {
                // a touch between two points is not detected
                if let Some(seen) = seen {
                    assert!(found.is_some_and(|found| (found - seen).abs() < 1e-4), "{signal:?} {level}");
                }
            }
            let limit = 0.3 + random::uniform(&mut stream);
            let mean =
                |of: &dyn Fn(f64) -> f64| values.iter().map(|value| of(value.1)).sum::<f64>() / 10_001.0;
            assert!((signal.mean(span) - mean(&|value| value)).abs() < 1e-3);
            let held = mean(&|value| value.clamp(-limit, limit) * value.clamp(-limit, limit));
            assert!((signal.mean_square_within(limit, span) - held).abs() < 2e-3, "{signal:?} {limit}");
        }
    }

    #[test]
    fn a_signal_that_stands_still_has_one_value() {
        let still = Quartic::constant(3.0);
        assert_eq!((still.extremes([0.0, 1.0]), still.mean([0.0, 1.0])), ([3.0, 3.0], 3.0));
        assert_eq!(
            (still.first_above(3.0, [0.0, 1.0]), still.last_above(3.0, [0.0, 1.0])),
            (Some(0.0), None)
        );
        assert!((still.mean_square_within(2.0, [0.0, 1.0]) - 4.0).abs() < 1e-14);
    }
}
