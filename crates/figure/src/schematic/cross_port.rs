//! Valve between the chambers, after ISO 1219-1: a restrictor, and the piston between springs that
//! passes no flow at rest.

use super::super::scene::{Anchor, Scene};
use super::CrossPortSymbol;
use super::mechanics::{PORT_FAR, PORT_NEAR};
use super::pen::{OUTLINE, block, lines, rows, spring};

/// Distance of the branch between the lines below the ports; between accumulators, whose branches
/// are adjacent.
const BELOW: f64 = 14.0;
const BELOW_BETWEEN: f64 = 5.0;
/// Width of the text between both lines.
const WIDE: f64 = 116.0;

/// Branch from line to line. Text is below it unless an accumulator occupies the space.
pub(super) fn cross_port(scene: &mut Scene, symbol: &CrossPortSymbol, has_room: bool) {
    let below = if has_room { BELOW } else { BELOW_BETWEEN };
    let (y, middle) = (PORT_FAR.1 + below, 0.5 * (PORT_FAR.0 + PORT_NEAR.0));
    lines(scene, &[(PORT_FAR.0, y), (PORT_NEAR.0, y)], OUTLINE);
    let at = if symbol.has_capacity { middle - 24.0 } else { middle };
    restrictor(scene, (at, y));
    if symbol.has_capacity {
        capacity(scene, (middle + 20.0, y));
    }
    if has_room {
        rows(scene, &symbol.rows, (middle, y + 12.0), Anchor::Middle, WIDE, 2);
    }
}

/// Restrictor: two curves that approach the line from both sides.
fn restrictor(scene: &mut Scene, (x, y): (f64, f64)) {
    for side in [-1.0, 1.0] {
        let curve = [(-8.0, 7.5), (-4.0, 4.2), (0.0, 3.2), (4.0, 4.2), (8.0, 7.5)];
        lines(scene, &curve.map(|(along, away)| (x + along, y + side * away)), OUTLINE);
    }
}

/// Piston between springs in its cylinder.
fn capacity(scene: &mut Scene, (x, y): (f64, f64)) {
    let (half, high) = (20.0, 7.0);
    block(scene, x - half, y - high, 2.0 * half, 2.0 * high);
    spring(scene, x - half, x, y, 3.0, OUTLINE);
    spring(scene, x, x + half, y, 3.0, OUTLINE);
    lines(scene, &[(x, y - high), (x, y + high)], OUTLINE);
}
