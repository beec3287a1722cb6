//! The direction that proves a leaf, or the axis across which it is better halved. This code need
//! not be trusted: the checker verifies its result.
//!
//! A direction at the angle phi proves the pair (U_k, V_k) if |phi - arg U_k| <= acos(|V_k|/|U_k|).
//! All pairs are proven if these arcs have a point in common; if they have none, two of them show
//! the axis across which they differ.

use num_complex::Complex64;
use phea_dynamics::portable;

use super::points::{PanelPoint, Points};

/// Result for a leaf.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum LeafOutcome {
    /// Direction that proves the leaf.
    Shown([i16; 2]),
    /// The leaf is to be halved across this axis.
    Halve(usize),
    /// The claim is false: at this corner |V| is greater than |U| by this ratio.
    Wrong {
        /// Corner, one bit for each axis; the lowest bit is that of the frequency.
        corner: u64,
        /// Ratio |V|/|U|.
        ratio: f64,
    },
}

/// The greatest component of a direction.
const FULL: f64 = 32767.0;
/// Length of the mean of unit directions below which it is inconclusive.
const CLEAR: f64 = 0.05;

/// Angle beyond which a point counts as pointing backwards, rad.
const BEHIND: f64 = 2.0;

/// Examines one leaf; `room` is the reserve for the rounding of the checker, as a fraction
/// of |V|^2.
pub(crate) fn leaf(points: &Points<f64>, room: f64) -> LeafOutcome {
    if let Some((corner, ratio)) = worst_corner(points) {
        return LeafOutcome::Wrong { corner, ratio };
    }
    let pairs = points.points();
    let Some(middle) = mean_direction(pairs) else { return LeafOutcome::Halve(most_varied(points)) };
    let near = rounded(middle);
    if shows(near, pairs, room) {
        return LeafOutcome::Shown(near);
    }
    if let Some(index) = turned_away(pairs, middle) {
        return LeafOutcome::Halve(back(points, index, middle));
    }
    let [mut low, mut high] = [(f64::NEG_INFINITY, 0), (f64::INFINITY, 0)];
    for (index, pair) in pairs.iter().enumerate() {
        let Some([from, to]) = arc(pair, middle) else { return LeafOutcome::Halve(across(points, index)) };
        if from > low.0 {
            low = (from, index);
        }
        if to < high.0 {
            high = (to, index);
        }
    }
    let angle = 0.5 * (low.0 + high.0);
    let direction = rounded(middle * portable::exp_complex(Complex64::new(0.0, angle)));
    if low.0 < high.0 && shows(direction, pairs, room) {
        return LeafOutcome::Shown(direction);
    }
    LeafOutcome::Halve(between(points, [low.1, high.1], middle))
}

/// The corner with the greatest |V|/|U| above one.
fn worst_corner(points: &Points<f64>) -> Option<(u64, f64)> {
    let wrong = corners(points).filter_map(|(corner, index)| {
        let [ur, ui, vr, vi, rest] = points.points()[index];
        // including the remainder of dead time
        let u = (ur * ur + ui * ui).sqrt() + 2.0 * rest;
        let (u, v) = (u * u, vr * vr + vi * vi);
        (v > u).then(|| (corner, (v / u).sqrt()))
    });
    wrong.max_by(|(_, one), (_, other)| one.total_cmp(other))
}

/// The corners, one bit for each axis, with their indices.
fn corners(points: &Points<f64>) -> impl Iterator<Item = (u64, usize)> {
    let steps: Vec<usize> =
        (0..points.axes()).map(|axis| points.degree(axis) * points.stride(axis)).collect();
    let idle = steps
        .iter()
        .enumerate()
        .filter(|(_, step)| **step == 0)
        .fold(0_u64, |bits, (axis, _)| bits | 1 << axis);
    let all = 0..1_u64 << steps.len();
    all.filter(move |corner| corner & idle == 0).map(move |corner| {
        let moved = steps.iter().enumerate().filter(|(axis, _)| corner >> axis & 1 == 1);
        (corner, moved.map(|(_, step)| step).sum())
    })
}

fn mean_direction(pairs: &[PanelPoint<f64>]) -> Option<Complex64> {
    let sum: Complex64 = pairs.iter().map(|[re, im, ..]| unit(Complex64::new(*re, *im))).sum();
    let length = portable::magnitude(sum);
    (length > CLEAR * pairs.len() as f64).then(|| sum / length)
}

fn unit(value: Complex64) -> Complex64 {
    let length = portable::magnitude(value);
    if length > 0.0 { value / length } else { value }
}

fn rounded(direction: Complex64) -> [i16; 2] {
    [direction.re, direction.im].map(|part| (part * FULL).round() as i16)
}

/// The condition of the checker, with room for its rounding.
fn shows(direction: [i16; 2], pairs: &[PanelPoint<f64>], room: f64) -> bool {
    let [a, b] = direction.map(f64::from);
    let square = (a * a + b * b) * (1.0 + room);
    pairs.iter().all(|[ur, ui, vr, vi, rest]| {
        let room = room * ((a * ur).abs() + (b * ui).abs());
        let least = a * ur + b * ui - (a.abs() + b.abs()) * rest - room;
        least > 0.0 && least * least >= square * (vr * vr + vi * vi)
    })
}

/// The arc of directions that prove a pair, relative to this one; `None` if there is none.
fn arc([ur, ui, vr, vi, rest]: &PanelPoint<f64>, middle: Complex64) -> Option<[f64; 2]> {
    let relative = Complex64::new(*ur, *ui) * middle.conj();
    let ratio = (portable::magnitude(Complex64::new(*vr, *vi)) + rest) / portable::magnitude(relative);
    let angle = portable::argument(relative);
    let half =
        (ratio < 1.0).then(|| portable::argument(Complex64::new(ratio, (1.0 - ratio * ratio).sqrt())))?;
    Some([angle - half, angle + half])
}

/// The point whose direction deviates most, if it points backwards: larger angles are nearly those
/// on the other side.
fn turned_away(pairs: &[PanelPoint<f64>], middle: Complex64) -> Option<usize> {
    let angles = pairs.iter().map(|pair| angle(pair, middle).abs()).enumerate();
    let (index, greatest) = angles.max_by(|(_, one), (_, other)| one.total_cmp(other))?;
    (greatest > BEHIND).then_some(index)
}

/// Chooses the axis along which a point in the wrong direction returns the most.
fn back(points: &Points<f64>, index: usize, middle: Complex64) -> usize {
    let of = |index: usize| angle(&points.points()[index], middle).abs();
    let gain = |axis: usize| {
        let [own, last] = place(points, index, axis);
        let stride = points.stride(axis);
        let line = (0..=last).map(|other| of(index - own * stride + other * stride));
        (last > 0).then(|| of(index) - line.fold(f64::INFINITY, f64::min))
    };
    greatest(points.axes(), gain).unwrap_or_else(|| most_varied(points))
}

/// Angle of U, relative to a direction.
fn angle([ur, ui, ..]: &PanelPoint<f64>, middle: Complex64) -> f64 {
    portable::argument(Complex64::new(*ur, *ui) * middle.conj())
}

/// The index of a point along an axis, and the last index.
fn place(points: &Points<f64>, index: usize, axis: usize) -> [usize; 2] {
    let degree = points.degree(axis);
    [index / points.stride(axis) % (degree + 1), degree]
}

/// Chooses the axis along which the line of a point bends most, among those where it is not at an
/// end: only there does halving move it.
fn across(points: &Points<f64>, index: usize) -> usize {
    let bend = |axis: usize| {
        let [own, last] = place(points, index, axis);
        let inside = own > 0 && own < last;
        let stride = points.stride(axis);
        inside.then(|| {
            let [before, here, next] = [index - stride, index, index + stride].map(|at| points.points()[at]);
            (0..before.len()).map(|part| (before[part] - 2.0 * here[part] + next[part]).abs()).sum()
        })
    };
    greatest(points.axes(), bend).unwrap_or_else(|| most_varied(points))
}

/// Chooses the axis that brings two conflicting arcs closest to each other, when one of the points
/// is moved along it to the index of the other.
fn between(points: &Points<f64>, [low, high]: [usize; 2], middle: Complex64) -> usize {
    let arc_at = |index: usize| arc(&points.points()[index], middle);
    let (Some([from, _]), Some([_, to])) = (arc_at(low), arc_at(high)) else { return most_varied(points) };
    let gain = |axis: usize| {
        let ([one, _], [other, _]) = (place(points, low, axis), place(points, high, axis));
        let stride = points.stride(axis);
        let moved = |index: usize, own: usize, there: usize| index - own * stride + there * stride;
        (one != other).then(|| {
            let lowered = arc_at(moved(low, one, other)).map_or(0.0, |[moved, _]| from - moved);
            let raised = arc_at(moved(high, other, one)).map_or(0.0, |[_, moved]| moved - to);
            lowered + raised
        })
    };
    greatest(points.axes(), gain).unwrap_or_else(|| most_varied(points))
}

/// The axis along which U and V vary most, all lines together.
pub(super) fn most_varied(points: &Points<f64>) -> usize {
    let variation = |axis: usize| {
        let stride = points.stride(axis);
        let pairs = points.points();
        let steps = pairs.iter().enumerate().filter(|(index, _)| place(points, *index, axis)[0] > 0);
        let sizes = steps.map(|(index, here)| {
            let before = &pairs[index - stride];
            here.iter().zip(before).map(|(one, other)| (one - other).abs()).sum::<f64>()
        });
        (points.degree(axis) > 0).then(|| sizes.sum())
    };
    greatest(points.axes(), variation).unwrap_or(0)
}

fn greatest(axes: usize, of: impl Fn(usize) -> Option<f64>) -> Option<usize> {
    let found = (0..axes).filter_map(|axis| Some((axis, of(axis)?)));
    found.max_by(|(_, one), (_, other)| one.total_cmp(other)).map(|(axis, _)| axis)
}
