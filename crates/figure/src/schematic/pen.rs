//! Strokes and small parts common to the symbols.

use super::super::colour::Role;
use super::super::scene::{
    Anchor, Baseline, Dash, Fill, PathStep, Point, Rectangle, Scene, Shape, Stroke, Text, point,
};
use super::super::{LABEL_SIZE, SMALL_SIZE, typeset};

/// Outline of components.
pub(super) const OUTLINE: Stroke = Stroke::solid(Role::Axis, 1.6);
/// Working line.
pub(super) const PIPE: Stroke = Stroke::solid(Role::Axis, 2.4);
/// Compliant line, the subject of the design.
pub(super) const HOSE: Stroke = Stroke::solid(Role::Series(0), 4.0);
/// Signal.
pub(super) const SIGNAL: Stroke = Stroke::solid(Role::Series(3), 1.5);
/// Measured signal.
pub(super) const MEASURED: Stroke = SIGNAL.dashed(Dash::Dashed);
/// Motion.
pub(super) const MOTION: Stroke = Stroke::solid(Role::Accent, 1.8);
/// Distance between rows of text.
pub(super) const ROW: f64 = 16.0;

/// Straight pieces.
pub(super) fn lines(scene: &mut Scene, points: &[(f64, f64)], stroke: Stroke) {
    let points: Vec<Point> = points.iter().map(|&(x, y)| point(x, y)).collect();
    scene.polyline(&points, stroke);
}

/// Box with the surface of components.
pub(super) fn block(scene: &mut Scene, left: f64, top: f64, width: f64, height: f64) {
    let area = Rectangle { left, top, right: left + width, bottom: top + height };
    scene.rectangle(area, Some(OUTLINE), Some(Fill::solid(Role::Surface)));
}

/// Filled arrow head with its tip at `tip`, pointing along (dx, dy) of length one.
pub(super) fn head(scene: &mut Scene, tip: (f64, f64), direction: (f64, f64), role: Role) {
    let ((x, y), (dx, dy)) = (tip, direction);
    let (length, half) = (8.0, 3.4);
    let (bx, by) = (x - length * dx, y - length * dy);
    let corners = [point(x, y), point(bx - half * dy, by + half * dx), point(bx + half * dy, by - half * dx)];
    scene.polygon(&corners, None, Some(Fill::solid(role)));
}

/// Arrow of an angle, over the rotating part.
pub(super) fn turn(scene: &mut Scene, (x, y): (f64, f64)) {
    let (from, to, top) = (point(x - 24.0, y), point(x + 24.0, y), y - 16.0);
    let bend = [point(x - 12.0, top), point(x + 12.0, top)];
    let path = vec![PathStep::Move(from), PathStep::Curve(bend[0], bend[1], to)];
    scene.shape(Shape::Path(path), Some(MOTION), None);
    head(scene, (to.x + 2.0, to.y + 3.0), (0.6, 0.8), MOTION.role);
}

/// Line with a head at its end; the line stops inside the head.
pub(super) fn arrow(scene: &mut Scene, from: (f64, f64), to: (f64, f64), stroke: Stroke) {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let length = (dx * dx + dy * dy).sqrt();
    let (ux, uy) = if length > 0.0 { (dx / length, dy / length) } else { (1.0, 0.0) };
    lines(scene, &[from, (to.0 - 6.0 * ux, to.1 - 6.0 * uy)], stroke);
    head(scene, to, (ux, uy), stroke.role);
}

/// Horizontal spring between two points of equal height.
pub(super) fn spring(scene: &mut Scene, from: f64, to: f64, y: f64, amplitude: f64, stroke: Stroke) {
    const TURNS: i32 = 4;
    let lead = 0.12 * (to - from);
    let (start, end) = (from + lead, to - lead);
    let step = (end - start) / f64::from(4 * TURNS);
    let mut points = vec![(from, y), (start, y)];
    for turn in 0..TURNS {
        let x = start + step * f64::from(4 * turn);
        points.extend([(x + step, y - amplitude), (x + 3.0 * step, y + amplitude)]);
    }
    points.extend([(end, y), (to, y)]);
    lines(scene, &points, stroke);
}

/// Curve with successive bends, like a hanging hose.
pub(super) fn flexible(scene: &mut Scene, from: (f64, f64), to: (f64, f64), sag: f64, stroke: Stroke) {
    let (a, b) = (point(from.0, from.1), point(to.0, to.1));
    let steps = vec![PathStep::Move(a), PathStep::Curve(point(a.x, a.y + sag), point(b.x, b.y - sag), b)];
    scene.shape(Shape::Path(steps), Some(stroke), None);
}

/// Arrow of adjustability through the middle of a symbol, after ISO 1219-1.
pub(super) fn adjustable(scene: &mut Scene, at: (f64, f64), (wide, high): (f64, f64)) {
    let [from, to] = [(at.0 - wide, at.1 + high), (at.0 + wide, at.1 - high)];
    arrow(scene, from, to, Stroke::solid(Role::Axis, 1.2));
}

/// Short diagonal strokes next to a vertical line: fixed ground.
pub(super) fn ground(scene: &mut Scene, x: f64, top: f64, bottom: f64) {
    lines(scene, &[(x, top), (x, bottom)], Stroke::solid(Role::Axis, 2.4));
    let count = ((bottom - top) / 8.0).clamp(0.0, 40.0) as usize;
    for index in 0..=count {
        let y = top + 8.0 * index as f64;
        lines(scene, &[(x, y), (x + 8.0, (y - 8.0).max(top - 6.0))], Stroke::solid(Role::Axis, 1.0));
    }
}

/// Rows of text below each other, from the top of the first row's capitals, each cut to `limit`.
pub(super) fn rows(
    scene: &mut Scene,
    texts: &[String],
    at: (f64, f64),
    anchor: Anchor,
    limit: f64,
    most: usize,
) {
    for (index, text) in texts.iter().take(most).enumerate() {
        let content = typeset::fitted(text, SMALL_SIZE, limit);
        let position = point(at.0, at.1 + ROW * index as f64);
        scene.text(Text::new(position, content, SMALL_SIZE).held(anchor, Baseline::Top));
    }
}

/// Text broken between words so that each row is at most this wide, if its words allow.
pub(super) fn wrapped(text: &str, limit: f64) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match found.last_mut() {
            Some(row) if typeset::width(&format!("{row} {word}"), SMALL_SIZE) <= limit => {
                row.push(' ');
                row.push_str(word);
            }
            _ => found.push(word.to_string()),
        }
    }
    found
}

/// Text in the middle of a space.
pub(super) fn word(scene: &mut Scene, text: &str, at: (f64, f64), role: Role) {
    let text = Text::new(point(at.0, at.1), text, LABEL_SIZE).held(Anchor::Middle, Baseline::Middle);
    scene.text(text.coloured(role));
}
