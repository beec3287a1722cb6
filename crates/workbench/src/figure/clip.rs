//! Cutting lines and polygons at a frame.
//!
//! A polyline is cut segment by segment (Liang and Barsky 1984): a segment that leaves the frame ends on its border, the
//! next one that enters starts a new run, and a point that is not a number ends the run. Nothing is ever moved onto
//! the border, so nothing smears along the frame. A polygon is cut side by side (Sutherland and Hodgman 1974).

use super::scene::{Point, Rectangle, point};

/// The part of the segment inside the frame, or `None`.
///
/// # Example
/// ```
/// use phea_workbench::figure::{clip::segment, scene::{Rectangle, point}};
/// let frame = Rectangle { left: 0.0, top: 0.0, right: 1.0, bottom: 1.0 };
/// let inside = segment(point(-1.0, 0.5), point(0.5, 0.5), &frame);
/// assert_eq!(inside, Some((point(0.0, 0.5), point(0.5, 0.5))));
/// assert_eq!(segment(point(-1.0, 2.0), point(2.0, 2.0), &frame), None);
/// ```
pub fn segment(from: Point, to: Point, frame: &Rectangle) -> Option<(Point, Point)> {
    let (dx, dy) = (to.x - from.x, to.y - from.y);
    if !(dx.is_finite() && dy.is_finite() && from.x.is_finite() && from.y.is_finite()) {
        return None;
    }
    let sides = [
        (-dx, from.x - frame.left),
        (dx, frame.right - from.x),
        (-dy, from.y - frame.top),
        (dy, frame.bottom - from.y),
    ];
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for (rate, distance) in sides {
        if rate == 0.0 {
            if distance < 0.0 {
                return None;
            }
        } else if rate < 0.0 {
            enter = enter.max(distance / rate);
        } else {
            leave = leave.min(distance / rate);
        }
    }
    if enter > leave {
        return None;
    }
    let at = |t: f64| {
        // Rounding may step over the border by an ulp; the answer lies on it.
        point(
            (from.x + t * dx).clamp(frame.left, frame.right),
            (from.y + t * dy).clamp(frame.top, frame.bottom),
        )
    };
    let start = if enter == 0.0 { from } else { at(enter) };
    let end = if leave == 1.0 { to } else { at(leave) };
    Some((start, end))
}

/// The runs of a polyline inside the frame, each of two points or more.
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

/// The polygon inside the frame; empty when they do not meet or a corner is not a number.
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

/// Keeps what has a depth of zero or more.
fn cut(corners: &[Point], depth: impl Fn(&Point) -> f64, frame: &Rectangle) -> Vec<Point> {
    let mut result = Vec::with_capacity(corners.len() + 2);
    let Some(mut previous) = corners.last() else { return result };
    for corner in corners {
        let (before, after) = (depth(previous), depth(corner));
        if (before < 0.0) != (after < 0.0) {
            let t = before / (before - after);
            let mut crossing =
                point(previous.x + t * (corner.x - previous.x), previous.y + t * (corner.y - previous.y));
            // Rounding may leave the crossing an ulp outside its own side.
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
