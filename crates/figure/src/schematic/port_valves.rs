//! Relief and check valves between a chamber and the tank, after ISO 1219-1.

use super::super::colour::Role;
use super::super::scene::{Dash, Fill, Scene, Stroke, point};
use super::pen::{OUTLINE, PIPE, arrow, block, lines, spring};

/// Distance of the branch below the port.
const BELOW: f64 = 6.0;
/// Distances of the valves from the pipe.
const ASIDE: [f64; 2] = [30.0, 66.0];
/// Half the side of a relief valve's box.
const HALF: f64 = 8.0;
/// Height of the valves with their tank, by which the text of the line is lower.
const HEIGHT: f64 = 46.0;

/// Valves of a port.
#[derive(Clone, Copy)]
enum Symbol {
    Relief,
    Check,
}

/// Valves on a branch below the port; `way` is 1 if they are right of it, and -1 if they are left
/// of it. Returns their height.
pub(super) fn port_valves(scene: &mut Scene, has: [bool; 2], port: (f64, f64), way: f64) -> f64 {
    let present = [Symbol::Relief, Symbol::Check].into_iter().zip(has).filter(|(_, has)| *has);
    let branch = port.1 + BELOW;
    let mut height = 0.0;
    for ((symbol, _), aside) in present.zip(ASIDE) {
        let (x, middle) = (port.0 + way * aside, branch + 20.0);
        lines(scene, &[(port.0, branch), (x, branch), (x, middle - HALF)], PIPE);
        lines(scene, &[(x, middle + HALF), (x, middle + 18.0)], PIPE);
        tank(scene, (x, middle + 18.0));
        match symbol {
            Symbol::Relief => relief(scene, (x, middle), way),
            Symbol::Check => check(scene, (x, middle)),
        }
        height = HEIGHT;
    }
    height
}

fn tank(scene: &mut Scene, (x, y): (f64, f64)) {
    lines(scene, &[(x - 8.0, y - 4.0), (x - 8.0, y + 4.0), (x + 8.0, y + 4.0), (x + 8.0, y - 4.0)], PIPE);
}

/// Relief valve, shut: a box whose arrow is aside of the flow, a spring, and the pilot line from
/// the chamber.
fn relief(scene: &mut Scene, (x, y): (f64, f64), way: f64) {
    let thin = Stroke::solid(Role::Axis, 1.2);
    block(scene, x - HALF, y - HALF, 2.0 * HALF, 2.0 * HALF);
    let across = x + way * 3.5;
    arrow(scene, (across, y - HALF + 1.0), (across, y + HALF - 1.0), thin);
    let [edge, end] = [x + way * HALF, x + way * (HALF + 9.0)];
    spring(scene, edge.min(end), edge.max(end), y, 3.0, thin);
    let (pilot, top) = (x - way * (HALF + 5.0), y - HALF - 4.0);
    lines(scene, &[(x, top), (pilot, top), (pilot, y), (x - way * HALF, y)], thin.dashed(Dash::Dashed));
}

/// Check valve that opens from the tank to the chamber: a ball on its seat.
fn check(scene: &mut Scene, (x, y): (f64, f64)) {
    lines(scene, &[(x - 7.0, y - 3.0), (x, y + HALF), (x + 7.0, y - 3.0)], OUTLINE);
    scene.circle(point(x, y - 2.0), 5.0, Some(OUTLINE), Some(Fill::solid(Role::Surface)));
    lines(scene, &[(x, y - HALF), (x, y - 7.0)], PIPE);
}
