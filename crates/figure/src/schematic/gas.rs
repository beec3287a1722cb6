//! Gas-charged accumulators at the chambers, after ISO 1219-1.

use super::super::colour::Role;
use super::super::scene::{Fill, Rectangle, Scene, Shape, point};
use super::AccumulatorSymbol;
use super::pen::{OUTLINE, PIPE, adjustable, lines};

/// Distance below a port at which the branch leaves its pipe.
pub(super) const BRANCH: f64 = 14.0;
/// Distance of the accumulator from the pipe.
const ASIDE: f64 = 42.0;
/// Half the length of a valve in the branch, and half its height.
const VALVE: (f64, f64) = (9.0, 6.0);

/// Accumulator below its branch: the triangle of the gas, hollow, points to the oil. `way` is 1 if
/// it is right of the port, and -1 if it is left of it.
pub(super) fn accumulator(scene: &mut Scene, kind: AccumulatorSymbol, port: (f64, f64), way: f64) {
    let (x, branch) = (port.0 + way * ASIDE, port.1 + BRANCH);
    let (top, half, height) = (branch + 6.0, 8.0, 32.0);
    lines(scene, &[port, (port.0, branch), (x, branch), (x, top)], PIPE);
    let shell = Rectangle { left: x - half, top, right: x + half, bottom: top + height };
    scene.shape(Shape::Rectangle(shell, half), Some(OUTLINE), Some(Fill::solid(Role::Surface)));
    let middle = top + 0.5 * height;
    lines(scene, &[(x - half, middle), (x + half, middle)], OUTLINE);
    let gas = [point(x, middle + 2.5), point(x - 4.0, middle + 9.5), point(x + 4.0, middle + 9.5)];
    scene.polygon(&gas, Some(OUTLINE), None);
    match kind {
        AccumulatorSymbol::Fixed => {}
        AccumulatorSymbol::Adjusted => adjustable(scene, (x, middle), (15.0, 15.0)),
        AccumulatorSymbol::ThroughValve => valve(scene, (0.5 * (port.0 + x), branch)),
    }
}

/// Shut-off valve: two triangles that meet, and the arrow of its actuation.
fn valve(scene: &mut Scene, (x, y): (f64, f64)) {
    let (long, half) = VALVE;
    for side in [-1.0, 1.0] {
        let corners = [point(x, y), point(x + side * long, y - half), point(x + side * long, y + half)];
        scene.polygon(&corners, Some(OUTLINE), Some(Fill::solid(Role::Surface)));
    }
    adjustable(scene, (x, y), (9.0, 11.0));
}
