//! Marks of a panel as primitives.

use std::collections::BTreeMap;

use phea_dynamics::portable::hypot;

use super::super::marker::draw_marker;
use super::super::placement::Occupancy;
use super::super::scene::{PathStep, Point, Rectangle, Scene, Shape, Stroke, point, run};
use super::super::{clip, simplify};
use super::layout::Placed;
use super::{AxisDirection, Mark};

/// Marks below the grid: bands and areas.
pub(super) fn bands(scene: &mut Scene, placed: &Placed<'_>, marks: &[Mark]) {
    for mark in marks {
        match mark {
            Mark::Band { direction, from, to, fill, hatched, .. } => {
                let Some(area) = band_area(placed, *direction, *from, *to) else { continue };
                scene.rectangle(area, None, Some(*fill));
                if *hatched {
                    hatch(scene, area, Stroke::solid(fill.role, 0.7));
                }
            }
            Mark::Area { corners, fill } => {
                let corners: Vec<Point> = corners.iter().map(|&(x, y)| placed.at(x, y)).collect();
                let inside = clip::polygon(&corners, &placed.frame);
                if inside.len() > 2 {
                    scene.polygon(&inside, None, Some(*fill));
                }
            }
            _ => {}
        }
    }
}

/// Marks above the grid: reference lines, curves, markers.
pub(super) fn marks(scene: &mut Scene, placed: &Placed<'_>, marks: &[Mark], occupancy: &mut Occupancy) {
    for mark in marks {
        match mark {
            Mark::Line { points, stroke } => {
                let points: Vec<Point> = points.iter().map(|&(x, y)| placed.at(x, y)).collect();
                let runs = clip::polyline(&points, &placed.frame);
                runs.iter().for_each(|piece| occupancy.add_polyline(piece, stroke.width));
                let steps: Vec<PathStep> =
                    runs.iter().flat_map(|piece| run(&simplify::polyline(piece), false)).collect();
                if !steps.is_empty() {
                    scene.shape(Shape::Path(steps), Some(*stroke), None);
                }
            }
            Mark::Fringe { points, stroke } => {
                let points: Vec<Point> = points.iter().map(|&(x, y)| placed.at(x, y)).collect();
                let runs = clip::polyline(&points, &placed.frame);
                let steps: Vec<PathStep> = runs.iter().flat_map(|run| fringe(run, &placed.frame)).collect();
                if !steps.is_empty() {
                    scene.shape(Shape::Path(steps), Some(*stroke), None);
                }
            }
            Mark::Dots { points, role, radius } => {
                let points = points.iter().map(|&(x, y)| placed.at(x, y));
                let seen = thinned(points.filter(|p| placed.frame.contains_point(*p)));
                let extent = |p: Point| Rectangle::from_corners(p, p).grown(*radius);
                seen.iter().for_each(|p| occupancy.add_obstacle(extent(*p)));
                // a line of zero length with round ends is a dot
                let steps: Vec<PathStep> =
                    seen.into_iter().flat_map(|p| [PathStep::Move(p), PathStep::Line(p)]).collect();
                if !steps.is_empty() {
                    scene.shape(Shape::Path(steps), Some(Stroke::solid(*role, 2.0 * radius)), None);
                }
            }
            Mark::Reference { direction, at, stroke, .. } => {
                if let Some((from, to)) = reference_line(placed, *direction, *at) {
                    occupancy.add_polyline(&[from, to], stroke.width);
                    scene.line(from, to, *stroke);
                }
            }
            Mark::Markers { points, style } => {
                for (x, y, note) in points {
                    let at = placed.at(*x, *y);
                    if placed.frame.contains_point(at) {
                        occupancy.add_obstacle(Rectangle::from_corners(at, at).grown(style.radius));
                        draw_marker(scene, at, *style, Some(note));
                    }
                }
            }
            _ => {}
        }
    }
}

/// Visible part of a band, or `None`.
pub(super) fn band_area(
    placed: &Placed<'_>,
    direction: AxisDirection,
    from: f64,
    to: f64,
) -> Option<Rectangle> {
    let axis = match direction {
        AxisDirection::X => placed.x,
        AxisDirection::Y => placed.y,
    };
    let (low, high) = (from.min(to).max(axis.minimum), from.max(to).min(axis.maximum));
    if from.is_nan() || to.is_nan() || low >= high {
        return None;
    }
    let (a, b) = match direction {
        AxisDirection::X => (placed.at(low, placed.y.minimum), placed.at(high, placed.y.maximum)),
        AxisDirection::Y => (placed.at(placed.x.minimum, low), placed.at(placed.x.maximum, high)),
    };
    Some(Rectangle::from_corners(a, b))
}

/// Ends of a reference line, or `None` if it is outside.
pub(super) fn reference_line(
    placed: &Placed<'_>,
    direction: AxisDirection,
    at: f64,
) -> Option<(Point, Point)> {
    let frame = placed.frame;
    match direction {
        AxisDirection::X => {
            let x = placed.x_at(at);
            (x >= frame.left && x <= frame.right).then(|| (point(x, frame.bottom), point(x, frame.top)))
        }
        AxisDirection::Y => {
            let y = placed.y_at(at);
            (y >= frame.top && y <= frame.bottom).then(|| (point(frame.left, y), point(frame.right, y)))
        }
    }
}

/// Strokes at equal distances along a run of points, slanted backwards to its right-hand side, cut
/// at the frame.
fn fringe(run: &[Point], frame: &Rectangle) -> Vec<PathStep> {
    const SPACING: f64 = 11.0;
    const LENGTH: f64 = 4.5;
    let mut steps = Vec::new();
    let mut ahead = 0.5 * SPACING;
    for pair in run.windows(2) {
        let &[from, to] = pair else { continue };
        let (dx, dy) = (to.x - from.x, to.y - from.y);
        let length = hypot(dx, dy);
        if length == 0.0 {
            continue;
        }
        let (ux, uy) = (LENGTH * dx / length, LENGTH * dy / length);
        while ahead <= length {
            let foot = point(from.x + ahead / length * dx, from.y + ahead / length * dy);
            let tip = point(foot.x - uy - 0.7 * ux, foot.y + ux - 0.7 * uy);
            if let Some((a, b)) = clip::segment(foot, tip, frame) {
                steps.extend([PathStep::Move(a), PathStep::Line(b)]);
            }
            ahead += SPACING;
        }
        ahead -= length;
    }
    steps
}

/// First of the points in each cell of three units, in order of position.
fn thinned(points: impl Iterator<Item = Point>) -> Vec<Point> {
    const CELL: f64 = 3.0;
    let mut cells: BTreeMap<(i32, i32), Point> = BTreeMap::new();
    for p in points {
        // coordinates within a figure are small
        cells.entry(((p.x / CELL).round() as i32, (p.y / CELL).round() as i32)).or_insert(p);
    }
    cells.into_values().collect()
}

/// Diagonal lines over an area.
fn hatch(scene: &mut Scene, area: Rectangle, stroke: Stroke) {
    const SPACING: f64 = 9.0;
    let count = ((area.width() + area.height()) / SPACING).clamp(0.0, 400.0) as usize;
    let mut steps = Vec::new();
    for index in 1..=count {
        let reach = SPACING * index as f64;
        let (from, to) = (point(area.left + reach, area.top), point(area.left, area.top + reach));
        if let Some((a, b)) = clip::segment(from, to, &area) {
            steps.extend([PathStep::Move(a), PathStep::Line(b)]);
        }
    }
    if !steps.is_empty() {
        scene.shape(Shape::Path(steps), Some(stroke), None);
    }
}
