//! Clipping of lines and polygons at a frame.
//!
//! A polyline is cut segment by segment (Liang and Barsky 1984): a segment that leaves the frame
//! ends on its border, the next one that enters starts a new run, and a NaN point ends the run. No
//! point is ever moved onto the border, so no line runs along the frame. A polygon is cut side by
//! side (Sutherland and Hodgman 1974).

use super::scene::{Point, Rectangle, point};

/// Part of the segment inside the frame, or `None`.
///
/// # Example
/// ```
/// use phea_figure::{clip::segment, scene::{Rectangle, point}};
/// let frame = Rectangle { left: 0.0, top: 0.0, right: 1.0, bottom: 1.0 };
/// let inside = segment(point(-1.0, 0.5), point(0.5, 0.5), &frame);
/// assert_eq!(inside, Some((point(0.0, 0.5), point(0.5, 0.5))));
/// assert_eq!(segment(point(-1.0, 2.0), point(2.0, 2.0), &frame), None);
/// ```
pub fn segment(from: Point, to: Point, frame: &Rectangle) -> Option<(Point, Point)> {
    // most segments of a picture are beyond one side of a label
    let beyond_across = from.x.max(to.x) < frame.left || frame.right < from.x.min(to.x);
    let beyond_upright = from.y.max(to.y) < frame.top || frame.bottom < from.y.min(to.y);
    if beyond_across || beyond_upright {
        return None;
    }
    let (dx, dy) = (to.x - from.x, to.y - from.y);
    if !(dx.is_finite() && dy.is_finite() && from.x.is_finite() && from.y.is_finite()) {
        return None;
    }
    // distance to each side, positive inside, at both ends
    let sides = [
        (from.x - frame.left, to.x - frame.left),
        (frame.right - from.x, frame.right - to.x),
        (from.y - frame.top, to.y - frame.top),
        (frame.bottom - from.y, frame.bottom - to.y),
    ];
    let (mut enter, mut leave) =
        (SegmentFraction { done: 0.0, left: 1.0 }, SegmentFraction { done: 1.0, left: 0.0 });
    for (at_from, at_to) in sides {
        let crossing = SegmentFraction { done: at_from / (at_from - at_to), left: at_to / (at_to - at_from) };
        if at_from < 0.0 && enter.is_before(crossing) {
            enter = crossing;
        } else if at_to < 0.0 && crossing.is_before(leave) {
            leave = crossing;
        }
    }
    if leave.is_before(enter) {
        return None;
    }
    let at = |place: SegmentFraction| {
        let (x, y) = if place.done < 0.5 {
            (from.x + place.done * dx, from.y + place.done * dy)
        } else {
            (to.x - place.left * dx, to.y - place.left * dy)
        };
        // rounding may exceed the border by an ulp; the result is on it
        point(x.clamp(frame.left, frame.right), y.clamp(frame.top, frame.bottom))
    };
    let start = if frame.contains_point(from) { from } else { at(enter) };
    let end = if frame.contains_point(to) { to } else { at(leave) };
    Some((start, end))
}

/// Position along a segment by the fractions before and after it: both, because one of them is lost
/// to rounding if an end is very far away.
#[derive(Clone, Copy)]
struct SegmentFraction {
    done: f64,
    left: f64,
}

impl SegmentFraction {
    fn is_before(self, other: SegmentFraction) -> bool {
        if self.done + other.done < 1.0 { self.done < other.done } else { self.left > other.left }
    }
}

/// Runs of a polyline inside the frame, each of two points or more.
pub fn polyline(points: &[Point], frame: &Rectangle) -> Vec<Vec<Point>> {
    let mut runs: Vec<Vec<Point>> = Vec::new();
    let mut current: Vec<Point> = Vec::new();
    for pair in points.windows(2) {
        let &[from, to] = pair else { continue };
        let Some((start, end)) = segment(from, to, frame) else {
            finish(&mut current, &mut runs);
            continue;
        };
        if current.last() != Some(&start) {
            finish(&mut current, &mut runs);
            current.push(start);
        }
        if end != start {
            current.push(end);
        }
    }
    finish(&mut current, &mut runs);
    runs
}

fn finish(current: &mut Vec<Point>, runs: &mut Vec<Vec<Point>>) {
    if current.len() > 1 {
        runs.push(std::mem::take(current));
    } else {
        current.clear();
    }
}

/// Polygon inside the frame; empty if they do not intersect or a corner is NaN.
pub fn polygon(corners: &[Point], frame: &Rectangle) -> Vec<Point> {
    if corners.iter().any(|p| !(p.x.is_finite() && p.y.is_finite())) {
        return Vec::new();
    }
    let mut result = corners.to_vec();
    for side in 0..4 {
        let depth = |p: &Point| match side {
            0 => p.x - frame.left,
            1 => frame.right - p.x,
            2 => p.y - frame.top,
            _ => frame.bottom - p.y,
        };
        result = cut(&result, depth, frame);
    }
    result
}

/// Keeps the parts with a depth of zero or more.
fn cut(corners: &[Point], depth: impl Fn(&Point) -> f64, frame: &Rectangle) -> Vec<Point> {
    let mut result = Vec::with_capacity(corners.len() + 2);
    let Some(mut previous) = corners.last() else { return result };
    for corner in corners {
        let (before, after) = (depth(previous), depth(corner));
        if (before < 0.0) != (after < 0.0) {
            let t = before / (before - after);
            let mut crossing =
                point(previous.x + t * (corner.x - previous.x), previous.y + t * (corner.y - previous.y));
            // rounding may leave the crossing an ulp outside its own side
            if depth(&crossing) < 0.0 {
                crossing = point(
                    crossing.x.clamp(frame.left, frame.right),
                    crossing.y.clamp(frame.top, frame.bottom),
                );
            }
            result.push(crossing);
        }
        if after >= 0.0 {
            result.push(*corner);
        }
        previous = corner;
    }
    result
}
