//! Cylinder, moving mass, load cell, environment.

use super::super::SMALL_SIZE;
use super::super::colour::Role;
use super::super::scene::{Anchor, Baseline, Fill, Rectangle, Scene, Stroke, Text, point};
use super::super::typeset;
use super::pen::{MOTION, OUTLINE, ROW, arrow, block, ground, lines, rows, spring, turn, word, wrapped};
use super::{Environment, Rods, STAGES, Schematic, SeriesKind, SeriesSymbol, lever};

/// Height of the rod's axis.
pub(super) const AXIS: f64 = 74.0;
const LEFT: f64 = 104.0;
const RIGHT: f64 = 300.0;
pub(super) const HALF: f64 = 26.0;
pub(super) const PISTON: f64 = 196.0;
pub(super) const ROD: f64 = 5.0;
pub(super) const MASS: f64 = 342.0;
/// Centre of the load cell: its signal starts below it.
pub(super) const CELL: f64 = 412.0;
/// Lower edge of the load cell.
pub(super) const CELL_BOTTOM: f64 = AXIS + 15.0;
const WALL: f64 = 520.0;
/// Position of the wall for a load on a lever, which is further right.
const WALL_OF_LEVER: f64 = 540.0;
/// Port of the chamber away from the load.
pub(super) const PORT_FAR: (f64, f64) = (LEFT + 30.0, AXIS + HALF);
/// Port of the chamber next to the load.
pub(super) const PORT_NEAR: (f64, f64) = (RIGHT - 30.0, AXIS + HALF);

/// Cylinder with piston, rods and the names of its chambers.
pub(super) fn cylinder(scene: &mut Scene, schematic: &Schematic) {
    let oil = Fill { role: Role::Series(0), opacity: 0.13 };
    let body = Rectangle { left: LEFT, top: AXIS - HALF, right: RIGHT, bottom: AXIS + HALF };
    scene.rectangle(body, None, Some(Fill::solid(Role::Background)));
    scene.rectangle(body, Some(OUTLINE), Some(oil));
    let rod_left = match schematic.rods {
        Rods::Both => LEFT - 44.0,
        Rods::TowardsLoad => PISTON,
    };
    let end = MASS - 20.0;
    let rod = Rectangle { left: rod_left, top: AXIS - ROD, right: end, bottom: AXIS + ROD };
    scene.rectangle(rod, Some(OUTLINE), Some(Fill::solid(Role::Surface)));
    pistons_within(scene, schematic.further_stages);
    let (far, near) = if schematic.load_at_b { ("A", "B") } else { ("B", "A") };
    for (name, x) in [(far, 0.5 * (LEFT + PISTON)), (near, 0.5 * (RIGHT + PISTON))] {
        word(scene, name, (x - 14.0, AXIS + 15.0), Role::Text);
        word(scene, &format!("p_{name}"), (x + 14.0, AXIS + 15.0), Role::Muted);
    }
    let text = typeset::fitted(&schematic.cylinder, SMALL_SIZE, 330.0);
    let at = point(0.5 * (LEFT + RIGHT), 8.0);
    scene.text(Text::new(at, text, SMALL_SIZE).held(Anchor::Middle, Baseline::Top));
    position_arrow(scene, schematic);
}

/// Piston; a telescopic one is a sleeve for each stage, with the piston in the last.
fn pistons_within(scene: &mut Scene, further_stages: usize) {
    let surface = Some(Fill::solid(Role::Surface));
    let mut half = HALF;
    for stage in 0..further_stages.min(STAGES) {
        let inner = half - 5.0;
        let reach = 18.0 - 4.0 * stage as f64;
        for [top, bottom] in [[AXIS - half, AXIS - inner], [AXIS + inner, AXIS + half]] {
            let sleeve = Rectangle { left: PISTON - reach, top, right: PISTON + reach, bottom };
            scene.rectangle(sleeve, Some(OUTLINE), surface);
        }
        half = inner;
    }
    let wide = if further_stages > 0 { 5.0 } else { 7.0 };
    let piston =
        Rectangle { left: PISTON - wide, top: AXIS - half, right: PISTON + wide, bottom: AXIS + half };
    scene.rectangle(piston, Some(OUTLINE), surface);
}

/// Arrow of the position x_p, which counts from the A end to the B end.
fn position_arrow(scene: &mut Scene, schematic: &Schematic) {
    let y = AXIS - HALF - 11.0;
    let (from, to) = if schematic.load_at_b { (PISTON, PISTON + 40.0) } else { (PISTON, PISTON - 40.0) };
    lines(scene, &[(from, y - 5.0), (from, y + 5.0)], MOTION);
    arrow(scene, (from, y), (to, y), MOTION);
    let away = if to > from { 13.0 } else { -13.0 };
    word(scene, "x_p", (to + away, y), Role::Accent);
}

/// Mass, load cell and environment on the axis of the rod.
pub(super) fn load(scene: &mut Scene, schematic: &Schematic) {
    let heavy = Stroke::solid(Role::Axis, 3.0);
    block(scene, MASS - 20.0, AXIS - 22.0, 40.0, 44.0);
    word(scene, schematic.motion.symbols().mass, (MASS, AXIS), Role::Text);
    let mass = [schematic.mass.clone()];
    // an inertia needs more space than a mass: above the text of the sensor
    let (top, wide) = if schematic.motion.is_rotary() { (4.0, 100.0) } else { (AXIS - 41.0, 56.0) };
    rows(scene, &mass, (MASS, top), Anchor::Middle, wide, 1);
    match &schematic.load_cell {
        Some(words) => {
            lines(scene, &[(MASS + 20.0, AXIS), (CELL - 17.0, AXIS)], heavy);
            block(scene, CELL - 17.0, AXIS - 15.0, 34.0, 30.0);
            word(scene, schematic.motion.symbols().measured, (CELL, AXIS), Role::Text);
            let top = if words.len() > 1 { AXIS - 41.0 - ROW } else { AXIS - 41.0 };
            rows(scene, words, (CELL, top), Anchor::Middle, 80.0, 2);
            lines(scene, &[(CELL + 17.0, AXIS), (CELL + 26.0, AXIS)], heavy);
        }
        None => lines(scene, &[(MASS + 20.0, AXIS), (CELL + 26.0, AXIS)], heavy),
    }
    let from = CELL + 26.0;
    let words = if schematic.linkage.is_some() { LeverSide::Yes } else { LeverSide::No };
    let from = schematic.series.as_ref().map_or(from, |series| between(scene, series, from, words));
    match &schematic.linkage {
        Some(linkage) => {
            // a mass is at the end of the lever, any other load next to the pin there
            let aside = if schematic.environment == Environment::SpringMassDamper { -12.0 } else { 4.0 };
            let from = lever::lever(scene, linkage, from) + aside;
            let place = EnvironmentPlace { from, axis: lever::LOAD, wall: WALL_OF_LEVER, words: 100.0 };
            environment(scene, schematic, &place, ["J", "θ_0"]);
        }
        None => {
            let place = EnvironmentPlace { from, axis: AXIS, wall: WALL, words: 132.0 };
            let names = if schematic.motion.is_rotary() { ["J_L", "θ_L"] } else { ["m", "x_L"] };
            environment(scene, schematic, &place, names);
        }
    }
}

/// Position of the environment.
struct EnvironmentPlace {
    /// Position of its support.
    from: f64,
    /// Height of its axis.
    axis: f64,
    /// Position of its ground.
    wall: f64,
    /// Width of its text.
    words: f64,
}

/// Presence of a lever to the right of an element.
#[derive(Clone, Copy, PartialEq, Eq)]
enum LeverSide {
    Yes,
    No,
}

/// Element between load cell and environment; returns its end.
fn between(scene: &mut Scene, series: &SeriesSymbol, from: f64, beside: LeverSide) -> f64 {
    let to = from + 34.0;
    let ends = |scene: &mut Scene, half: f64| {
        for x in [from, to] {
            lines(scene, &[(x, AXIS - half), (x, AXIS + half)], Stroke::solid(Role::Axis, 3.0));
        }
    };
    match series.kind {
        SeriesKind::Spring => {
            ends(scene, 9.0);
            spring(scene, from, to, AXIS, 7.0, OUTLINE);
        }
        SeriesKind::DampedSpring => {
            ends(scene, 14.0);
            spring(scene, from, to, AXIS - 8.0, 5.0, OUTLINE);
            damper(scene, from, to, AXIS + 8.0);
        }
        SeriesKind::Transmission => pistons(scene, from, to),
    }
    match beside {
        LeverSide::No => {
            let words = [series.words.clone()];
            rows(scene, &words, (0.5 * (from + to) + 6.0, AXIS + 20.0), Anchor::Middle, 84.0, 1);
        }
        // between the signal of the load cell and the lever
        LeverSide::Yes => {
            let words = wrapped(&series.words, 52.0);
            rows(scene, &words, (to - 4.0, AXIS + 20.0), Anchor::End, 52.0, 2);
        }
    }
    to
}

/// Two cylinders with a line between them, and their rods.
fn pistons(scene: &mut Scene, from: f64, to: f64) {
    let heavy = Stroke::solid(Role::Axis, 3.0);
    for (rod, inner) in [(from, from + 13.0), (to, to - 13.0)] {
        let [left, right] = [rod.min(inner), rod.max(inner)];
        block(scene, left, AXIS - 10.0, right - left, 20.0);
        let piston = 0.5 * (rod + inner);
        lines(scene, &[(piston, AXIS - 10.0), (piston, AXIS + 10.0)], heavy);
        lines(scene, &[(rod, AXIS), (piston, AXIS)], heavy);
    }
    // from chamber to chamber, away from the rods
    let [one, other, low] = [from + 10.0, to - 10.0, AXIS + 16.0];
    let hose = [(one, AXIS + 10.0), (one, low), (other, low), (other, AXIS + 10.0)];
    lines(scene, &hose, Stroke::solid(Role::Axis, 2.0));
}

/// Environment with the names of its mass and of its position.
fn environment(
    scene: &mut Scene,
    schematic: &Schematic,
    place: &EnvironmentPlace,
    [mass, position]: [&str; 2],
) {
    let &EnvironmentPlace { from, axis, wall, words } = place;
    match schematic.environment {
        Environment::PrescribedMotion => {
            // its arrow needs space to the right
            let wall = wall.min(WALL);
            spring(scene, from, wall - 6.0, axis, 9.0, OUTLINE);
            let plate =
                Rectangle { left: wall - 6.0, top: axis - 32.0, right: wall + 6.0, bottom: axis + 32.0 };
            scene.rectangle(plate, Some(OUTLINE), Some(Fill::solid(Role::Surface)));
            let y = axis - 44.0;
            if schematic.motion.is_rotary() || schematic.linkage.is_some() {
                turn(scene, (wall, y + 4.0));
                word(scene, position, (wall, y - 17.0), Role::Accent);
            } else {
                arrow(scene, (wall, y), (wall + 26.0, y), MOTION);
                arrow(scene, (wall, y), (wall - 26.0, y), MOTION);
                word(scene, position, (wall, y - 13.0), Role::Accent);
            }
        }
        Environment::Wall => {
            spring(scene, from, wall, axis, 9.0, OUTLINE);
            ground(scene, wall, axis - 30.0, axis + 30.0);
        }
        Environment::SpringMassDamper => {
            block(scene, from, axis - 18.0, 24.0, 36.0);
            word(scene, mass, (from + 12.0, axis), Role::Text);
            spring(scene, from + 24.0, wall, axis - 10.0, 6.0, OUTLINE);
            damper(scene, from + 24.0, wall, axis + 10.0);
            ground(scene, wall, axis - 30.0, axis + 30.0);
        }
    }
    rows(scene, &schematic.environment_rows, (WALL + 32.0, axis + 40.0), Anchor::End, words, 2);
}

fn damper(scene: &mut Scene, from: f64, to: f64, y: f64) {
    let middle = 0.5 * (from + to);
    lines(scene, &[(from, y), (middle, y)], OUTLINE);
    lines(scene, &[(middle, y - 4.0), (middle, y + 4.0)], OUTLINE);
    lines(
        scene,
        &[(middle - 8.0, y - 6.0), (middle + 8.0, y - 6.0), (middle + 8.0, y + 6.0), (middle - 8.0, y + 6.0)],
        OUTLINE,
    );
    lines(scene, &[(middle + 8.0, y), (to, y)], OUTLINE);
}
