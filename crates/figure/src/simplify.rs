//! Reduction of points of a curve: a response of a thousand samples becomes a path of a hundred
//! corners.

use phea_dynamics::portable::hypot;

use super::scene::Point;

/// Largest distance of an omitted point from the drawn line, in view box units: a twelfth of a
/// pixel at twice the size.
pub const TOLERANCE: f64 = 0.04;

/// Directions from an anchor that pass every point since within the tolerance.
struct Cone {
    anchor: Point,
    /// Bounding directions, clockwise and counter-clockwise; `None` until a point is far enough to
    /// give one.
    bounds: Option<((f64, f64), (f64, f64))>,
    farthest: f64,
}

impl Cone {
    fn at(anchor: Point) -> Self {
        Cone { anchor, bounds: None, farthest: 0.0 }
    }

    /// Narrows the cone by a point; returns false if the point is outside or the curve reverses.
    fn admits(&mut self, p: Point) -> bool {
        let (dx, dy) = (p.x - self.anchor.x, p.y - self.anchor.y);
        let distance = hypot(dx, dy);
        if distance <= TOLERANCE {
            return self.farthest <= 2.0 * TOLERANCE;
        }
        if distance + TOLERANCE < self.farthest {
            return false;
        }
        self.farthest = self.farthest.max(distance);
        let (ux, uy) = (dx / distance, dy / distance);
        let sine = TOLERANCE / distance;
        let cosine = (1.0 - sine * sine).sqrt();
        let low = (ux * cosine + uy * sine, uy * cosine - ux * sine);
        let high = (ux * cosine - uy * sine, uy * cosine + ux * sine);
        let Some((first, last)) = self.bounds else {
            self.bounds = Some((low, high));
            return true;
        };
        let cross = |a: (f64, f64), b: (f64, f64)| a.0 * b.1 - a.1 * b.0;
        let ahead = first.0 * ux + first.1 * uy > 0.0;
        if !ahead || cross(first, (ux, uy)) < 0.0 || cross((ux, uy), last) < 0.0 {
            return false;
        }
        let narrowed_first = if cross(first, low) > 0.0 { low } else { first };
        let narrowed_last = if cross(high, last) > 0.0 { high } else { last };
        self.bounds = Some((narrowed_first, narrowed_last));
        true
    }
}

/// Corners of a polyline that define its shape; both ends stay.
///
/// # Example
/// ```
/// use phea_figure::{scene::point, simplify::polyline};
/// let straight: Vec<_> = (0..100).map(|i| point(f64::from(i), 2.0 * f64::from(i))).collect();
/// assert_eq!(polyline(&straight), [straight[0], straight[99]]);
/// ```
pub fn polyline(points: &[Point]) -> Vec<Point> {
    let (Some(first), Some(last)) = (points.first(), points.last()) else { return Vec::new() };
    let mut kept = vec![*first];
    let mut cone = Cone::at(*first);
    let mut previous = *first;
    for p in points.iter().skip(1) {
        if !cone.admits(*p) {
            kept.push(previous);
            cone = Cone::at(previous);
            cone.admits(*p);
        }
        previous = *p;
    }
    if points.len() > 1 {
        kept.push(*last);
    }
    kept
}
