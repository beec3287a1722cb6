//! Markers of points.

use super::colour::Role;
use super::scene::{Fill, Item, PathStep, Point, Scene, Shape, Stroke, point, run};

/// Shape of a marker.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    /// Filled circle.
    Circle,
    /// Circle without filling: a zero of a transfer function.
    Ring,
    /// Filled square.
    Square,
    /// Filled triangle.
    Triangle,
    /// Filled square on its corner.
    Diamond,
    /// Square on its corner without filling.
    OpenDiamond,
    /// Square without filling.
    OpenSquare,
    /// Diagonal cross: a pole of a transfer function, or a rejection.
    Cross,
    /// Upright cross.
    Plus,
}

/// Marker with colour and size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MarkerStyle {
    /// Shape.
    pub marker: Marker,
    /// Colour by role.
    pub role: Role,
    /// Half width.
    pub radius: f64,
}

/// Draws a marker, with a tooltip if there is one.
pub(crate) fn draw_marker(scene: &mut Scene, at: Point, style: MarkerStyle, note: Option<&str>) {
    let r = style.radius;
    let by = |dx: f64, dy: f64| point(at.x + dx * r, at.y + dy * r);
    let filled = (Some(Stroke::solid(Role::Background, 1.0)), Some(Fill::solid(style.role)));
    let open = (Some(Stroke::solid(style.role, 2.0)), None);
    let polygon = |corners: &[Point]| Shape::Path(run(corners, true));
    let arms = |ends: &[(Point, Point)]| {
        Shape::Path(ends.iter().flat_map(|(a, b)| [PathStep::Move(*a), PathStep::Line(*b)]).collect())
    };
    let (shape, (stroke, fill)) = match style.marker {
        Marker::Circle => (Shape::Circle(at, r), filled),
        Marker::Ring => (Shape::Circle(at, r), open),
        Marker::Square => (polygon(&[by(-0.9, -0.9), by(0.9, -0.9), by(0.9, 0.9), by(-0.9, 0.9)]), filled),
        Marker::OpenSquare => (polygon(&[by(-1.0, -1.0), by(1.0, -1.0), by(1.0, 1.0), by(-1.0, 1.0)]), open),
        Marker::OpenDiamond => (polygon(&[by(0.0, -1.3), by(1.3, 0.0), by(0.0, 1.3), by(-1.3, 0.0)]), open),
        Marker::Triangle => (polygon(&[by(0.0, -1.2), by(1.1, 0.8), by(-1.1, 0.8)]), filled),
        Marker::Diamond => (polygon(&[by(0.0, -1.3), by(1.3, 0.0), by(0.0, 1.3), by(-1.3, 0.0)]), filled),
        Marker::Cross => (arms(&[(by(-1.0, -1.0), by(1.0, 1.0)), (by(-1.0, 1.0), by(1.0, -1.0))]), open),
        Marker::Plus => (arms(&[(by(-1.3, 0.0), by(1.3, 0.0)), (by(0.0, -1.3), by(0.0, 1.3))]), open),
    };
    let note = note.filter(|text| !text.is_empty()).map(str::to_string);
    scene.items.push(Item::Drawing { shape, stroke, fill, note });
}
