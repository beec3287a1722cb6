//! Shape-preserving cubics through points.

use super::Profile;
use super::piece::{PieceShape, ProfilePiece};

/// Interval between two neighbouring points.
#[derive(Clone, Copy)]
struct InterpolationInterval {
    start_s: f64,
    length_s: f64,
    from: f64,
    to: f64,
}

impl InterpolationInterval {
    fn slope(self) -> f64 {
        (self.to - self.from) / self.length_s
    }

    /// Cubic through the two points with these slopes.
    fn cubic(self, [left, right]: [f64; 2]) -> ProfilePiece {
        let (rise, left, right) = (self.to - self.from, left * self.length_s, right * self.length_s);
        let [square, cube] = [3.0 * rise - 2.0 * left - right, left + right - 2.0 * rise];
        let coefficients = [self.from, left, square, cube, 0.0, 0.0];
        ProfilePiece::new(PieceShape::Polynomial {
            origin_s: self.start_s,
            span_s: self.length_s,
            coefficients,
        })
    }
}

/// Interpolant through at least two points at increasing times.
pub(super) fn through(times_s: &[f64], values: &[f64]) -> Profile {
    let points: Vec<(f64, f64)> = times_s.iter().copied().zip(values.iter().copied()).collect();
    let between = |pair: &[(f64, f64)]| match pair {
        [(start_s, from), (end_s, to)] => {
            Some(InterpolationInterval { start_s: *start_s, length_s: end_s - start_s, from: *from, to: *to })
        }
        _ => None,
    };
    let intervals: Vec<InterpolationInterval> = points.windows(2).filter_map(between).collect();
    let slopes = slopes(&intervals);
    let constant = |value| ProfilePiece::new(PieceShape::Constant { value });
    let mut later: Vec<(f64, ProfilePiece)> = intervals
        .iter()
        .zip(slopes.iter().zip(slopes.iter().skip(1)))
        .map(|(interval, (left, right))| (interval.start_s, interval.cubic([*left, *right])))
        .collect();
    later.extend(points.last().map(|&(time_s, value)| (time_s, constant(value))));
    Profile { first: constant(points.first().map_or(0.0, |point| point.1)), later }
}

/// Slopes at the points.
fn slopes(intervals: &[InterpolationInterval]) -> Vec<f64> {
    let inner = intervals.windows(2).map(|pair| match pair {
        [before, after] => inner_slope(*before, *after),
        _ => 0.0,
    });
    let end =
        |nearest: Option<&InterpolationInterval>, next: Option<&InterpolationInterval>| match (nearest, next)
        {
            (Some(nearest), Some(next)) => end_slope(*nearest, *next),
            (Some(only), None) => only.slope(),
            _ => 0.0,
        };
    let first = end(intervals.first(), intervals.get(1));
    let last = end(intervals.last(), intervals.len().checked_sub(2).and_then(|index| intervals.get(index)));
    std::iter::once(first).chain(inner).chain([last]).collect()
}

/// Weighted harmonic mean of the slopes on both sides; zero at an extreme point.
fn inner_slope(before: InterpolationInterval, after: InterpolationInterval) -> f64 {
    let [steep_before, steep_after] = [before.slope(), after.slope()];
    if steep_before * steep_after <= 0.0 {
        return 0.0;
    }
    let weight_before = 2.0 * after.length_s + before.length_s;
    let weight_after = after.length_s + 2.0 * before.length_s;
    (weight_before + weight_after) / (weight_before / steep_before + weight_after / steep_after)
}

/// Slope of the parabola through the three points nearest to an end, limited so that the shape is
/// preserved.
fn end_slope(nearest: InterpolationInterval, next: InterpolationInterval) -> f64 {
    let [steep, steep_next] = [nearest.slope(), next.slope()];
    let parabola = ((2.0 * nearest.length_s + next.length_s) * steep - nearest.length_s * steep_next)
        / (nearest.length_s + next.length_s);
    if parabola * steep <= 0.0 {
        0.0
    } else if steep * steep_next <= 0.0 && parabola.abs() > 3.0 * steep.abs() {
        3.0 * steep
    } else {
        parabola
    }
}
