//! Lever between the rod and a load that turns about a joint.

use super::super::colour::Role;
use super::super::scene::{Anchor, Fill, PathStep, Scene, Shape, Stroke, point};
use super::LinkageSymbol;
use super::mechanics::{AXIS, CELL};
use super::pen::{MOTION, OUTLINE, head, lines, rows, word};

/// Height of the joint: r above the rod's axis.
const JOINT: f64 = AXIS - 36.0;
/// Height of the end that holds the load.
pub(super) const LOAD: f64 = AXIS + 60.0;
/// Least x of the joint: right of the text of the load cell.
const LEAST_PLACE: f64 = CELL + 54.0;
/// Right edge of the text.
const RIGHT: f64 = 558.0;

/// Lever with its joint above, the rod's end between, and the load below; returns its position.
pub(super) fn lever(scene: &mut Scene, symbol: &LinkageSymbol, from: f64) -> f64 {
    let heavy = Stroke::solid(Role::Axis, 3.0);
    let x = LEAST_PLACE.max(from + 14.0);
    lines(scene, &[(from, AXIS), (x, AXIS)], heavy);
    joint_on_ground(scene, x);
    lines(scene, &[(x, JOINT), (x, LOAD)], Stroke::solid(Role::Axis, 5.0));
    for y in [JOINT, AXIS, LOAD] {
        scene.circle(point(x, y), 4.0, Some(OUTLINE), Some(Fill::solid(Role::Background)));
    }
    arm(scene, x);
    angle(scene, x);
    let most = RIGHT - x - 14.0;
    rows(scene, &symbol.rows, (x + 14.0, JOINT - 18.0), Anchor::Start, most, 3);
    x
}

/// Bearing that holds the joint.
fn joint_on_ground(scene: &mut Scene, x: f64) {
    let top = JOINT - 14.0;
    let bearing = [point(x, JOINT), point(x - 8.0, top), point(x + 8.0, top)];
    scene.polygon(&bearing, Some(OUTLINE), Some(Fill::solid(Role::Surface)));
    lines(scene, &[(x - 11.0, top), (x + 11.0, top)], Stroke::solid(Role::Axis, 2.4));
    for index in 0..4 {
        let left = x - 10.0 + 6.0 * f64::from(index);
        lines(scene, &[(left, top), (left + 5.0, top - 6.0)], Stroke::solid(Role::Axis, 1.0));
    }
}

/// Lever arm r from the joint to the line of the rod.
fn arm(scene: &mut Scene, x: f64) {
    let left = x - 11.0;
    let thin = Stroke::solid(Role::Muted, 1.0);
    for y in [JOINT, AXIS - 3.0] {
        lines(scene, &[(left - 3.0, y), (left + 3.0, y)], thin);
    }
    lines(scene, &[(left, JOINT), (left, AXIS - 3.0)], thin);
    word(scene, "r", (left - 8.0, JOINT + 14.0), Role::Muted);
}

/// Arrow of the angle, which grows while the rod extends.
fn angle(scene: &mut Scene, x: f64) {
    let (from, end) = (point(x - 42.0, LOAD - 9.0), point(x - 20.0, LOAD + 2.0));
    let path = vec![
        PathStep::Move(from),
        PathStep::Curve(point(from.x + 6.0, from.y + 6.0), point(end.x - 8.0, end.y), end),
    ];
    scene.shape(Shape::Path(path), Some(MOTION), None);
    head(scene, (end.x + 5.0, end.y), (1.0, 0.0), MOTION.role);
    word(scene, "θ", (x - 36.0, LOAD + 9.0), Role::Accent);
}
