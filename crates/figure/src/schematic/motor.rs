//! Motor in place of the cylinder, after ISO 1219-1: a circle with a triangle at each port, and its
//! shaft towards the load.

use super::super::SMALL_SIZE;
use super::super::colour::Role;
use super::super::scene::{Anchor, Baseline, Fill, Rectangle, Scene, Text, point};
use super::super::typeset;
use super::Schematic;
use super::mechanics::{AXIS, HALF, MASS, PISTON, PORT_FAR, PORT_NEAR, ROD};
use super::pen::{OUTLINE, PIPE, head, lines, turn, word};

/// Height of the ports.
const PORTS: f64 = AXIS + 16.0;

/// Motor with its ports, its shaft and the direction of its angle.
pub(super) fn motor(scene: &mut Scene, schematic: &Schematic) {
    for (port, inwards) in [(PORT_FAR, 1.0), (PORT_NEAR, -1.0)] {
        let edge = PISTON - inwards * (HALF * HALF - 16.0 * 16.0).sqrt();
        lines(scene, &[port, (port.0, PORTS), (edge, PORTS)], PIPE);
    }
    let shaft = Rectangle { left: PISTON, top: AXIS - ROD, right: MASS - 20.0, bottom: AXIS + ROD };
    scene.rectangle(shaft, Some(OUTLINE), Some(Fill::solid(Role::Surface)));
    let oil = Fill { role: Role::Series(0), opacity: 0.13 };
    let centre = point(PISTON, AXIS);
    scene.circle(centre, HALF, None, Some(Fill::solid(Role::Background)));
    scene.circle(centre, HALF, Some(OUTLINE), Some(oil));
    // a bidirectional motor: oil enters at either side
    head(scene, (PISTON - HALF + 11.0, AXIS), (1.0, 0.0), Role::Axis);
    head(scene, (PISTON + HALF - 11.0, AXIS), (-1.0, 0.0), Role::Axis);
    let (far, near) = if schematic.load_at_b { ("A", "B") } else { ("B", "A") };
    for (name, x, way) in [(far, PORT_FAR.0, -1.0), (near, PORT_NEAR.0, 1.0)] {
        word(scene, name, (x + 14.0 * way, PORTS + 4.0), Role::Text);
        word(scene, &format!("p_{name}"), (x + 36.0 * way, PORTS + 4.0), Role::Muted);
    }
    // as wide as the inertia of the load allows
    let text = typeset::fitted(&schematic.cylinder, SMALL_SIZE, 220.0);
    scene.text(Text::new(point(PISTON - 18.0, 4.0), text, SMALL_SIZE).held(Anchor::Middle, Baseline::Top));
    // the angle grows while oil enters chamber A
    turn(scene, (PISTON, AXIS - 24.0));
    word(scene, schematic.motion.symbols().position, (PISTON + 44.0, AXIS - 30.0), Role::Accent);
}
