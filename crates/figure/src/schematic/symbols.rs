//! Supply, tank, lines, servovalve and the blocks of the controller.

use super::super::colour::Role;
use super::super::scene::{Anchor, Fill, Scene, Stroke, point};
use super::mechanics::{CELL, CELL_BOTTOM, PORT_FAR, PORT_NEAR};
use super::pen::{
    HOSE, MEASURED, OUTLINE, PIPE, ROW, SIGNAL, arrow, block, flexible, head, lines, rows, spring, word,
};
use super::{ControllerSymbol, LINE_ROWS, LineKind, Schematic, SupplyKind};
use super::{gas, port_valves};

/// Middle of the valve.
pub(super) const VALVE: (f64, f64) = (202.0, 232.0);
/// Largest number of text rows of a line below the valves at its port.
const ROWS_BELOW_VALVES: usize = 3;
/// Side of one of the valve's boxes.
const SIDE: f64 = 46.0;
pub(super) const PORT: f64 = 12.0;
pub(super) const TOP: f64 = VALVE.1 - 0.5 * SIDE;
const BOTTOM: f64 = VALVE.1 + 0.5 * SIDE;
/// Top of the text of the controller, below that of the valve.
pub(super) const CONTROLLER_ROWS: f64 = BOTTOM + 16.0 + 2.0 * ROW + 8.0;
/// Right end of the valve with its torque motor.
pub(super) const VALVE_END: f64 = VALVE.0 + 1.5 * SIDE + 24.0;

/// Pressure source or pump, and the tank.
pub(super) fn supply(scene: &mut Scene, schematic: &Schematic) {
    feed(scene, schematic.supply, &schematic.supply_rows, &schematic.tank);
}

/// Supply by its text.
pub(super) fn feed(scene: &mut Scene, supply: SupplyKind, supply_rows: &[String], tank_word: &str) {
    let (pressure, tank) = (VALVE.0 - PORT, VALVE.0 + PORT);
    let source = (pressure - 60.0, 318.0);
    lines(
        scene,
        &[(pressure, BOTTOM), (pressure, 284.0), (source.0, 284.0), (source.0, source.1 - 16.0)],
        PIPE,
    );
    match supply {
        SupplyKind::ConstantPressure => {
            let triangle = [
                point(source.0, source.1 - 16.0),
                point(source.0 - 13.0, source.1 + 7.0),
                point(source.0 + 13.0, source.1 + 7.0),
            ];
            scene.polygon(&triangle, None, Some(Fill::solid(Role::Axis)));
        }
        SupplyKind::Pump => {
            scene.circle(point(source.0, source.1), 16.0, Some(OUTLINE), Some(Fill::solid(Role::Surface)));
            let triangle = [
                point(source.0, source.1 - 16.0),
                point(source.0 - 6.0, source.1 - 6.0),
                point(source.0 + 6.0, source.1 - 6.0),
            ];
            scene.polygon(&triangle, None, Some(Fill::solid(Role::Axis)));
            lines(scene, &[(source.0, source.1 + 16.0), (source.0, 350.0)], PIPE);
            tank_symbol(scene, source.0, 350.0);
        }
    }
    rows(scene, supply_rows, (source.0 - 24.0, source.1 - 12.0), Anchor::End, 104.0, 2);
    lines(scene, &[(tank, BOTTOM), (tank, 322.0)], PIPE);
    tank_symbol(scene, tank, 322.0);
    rows(scene, &[tank_word.to_string()], (tank + 24.0, 316.0), Anchor::Start, 62.0, 1);
    word(scene, "P", (pressure - 10.0, BOTTOM + 11.0), Role::Muted);
    word(scene, "T", (tank + 10.0, BOTTOM + 11.0), Role::Muted);
}

fn tank_symbol(scene: &mut Scene, x: f64, bottom: f64) {
    lines(
        scene,
        &[
            (x - 15.0, bottom - 6.0),
            (x - 15.0, bottom + 6.0),
            (x + 15.0, bottom + 6.0),
            (x + 15.0, bottom - 6.0),
        ],
        PIPE,
    );
}

/// Both lines with their text.
pub(super) fn working_lines(scene: &mut Scene, schematic: &Schematic) {
    let (far, near) = if schematic.load_at_b {
        (&schematic.line_a, &schematic.line_b)
    } else {
        (&schematic.line_b, &schematic.line_a)
    };
    let places = [
        (far, PORT_FAR, VALVE.0 - PORT, PORT_FAR.0 - 16.0, Anchor::End),
        (near, PORT_NEAR, VALVE.0 + PORT, PORT_NEAR.0 + 16.0, Anchor::Start),
    ];
    for (line, port, valve_x, text_x, anchor) in places {
        // the branch to the gas is at the chamber, before the line begins
        let branched = match (&line.accumulator, &schematic.cross_port) {
            (Some(_), _) => gas::BRANCH + 10.0,
            (None, Some(_)) => 12.0,
            (None, None) => 0.0,
        };
        let (top, bottom) = ((port.0, port.1 + 10.0 + branched), (valve_x, TOP - 12.0));
        lines(scene, &[(port.0, port.1), top], PIPE);
        lines(scene, &[bottom, (valve_x, TOP)], PIPE);
        match line.kind {
            LineKind::Hose => {
                flexible(scene, top, bottom, 78.0, HOSE);
                for (x, y) in [top, bottom] {
                    scene.circle(point(x, y), 3.6, None, Some(Fill::solid(HOSE.role)));
                }
            }
            LineKind::Pipe => {
                let bend = 0.5 * (top.1 + bottom.1);
                lines(scene, &[top, (top.0, bend), (bottom.0, bend), bottom], PIPE);
            }
        }
        if let Some(kind) = line.accumulator {
            gas::accumulator(scene, kind, port, if port.0 < valve_x { 1.0 } else { -1.0 });
        }
        let way = if port.0 < valve_x { -1.0 } else { 1.0 };
        let below = port_valves::port_valves(scene, [line.has_relief, line.has_check], port, way);
        let most = if below > 0.0 { ROWS_BELOW_VALVES } else { LINE_ROWS };
        rows(scene, &line.rows, (text_x, 116.0 + below), anchor, 112.0, most);
    }
}

/// Servovalve with 4 ports and 3 positions: continuous between them, spring on one side and torque
/// motor on the other.
pub(super) fn valve(scene: &mut Scene, schematic: &Schematic) {
    let ports = if schematic.load_at_b { ["A", "B"] } else { ["B", "A"] };
    valve_with(scene, ports, &schematic.valve_rows);
}

/// Servovalve by the names of its ports and its text.
pub(super) fn valve_with(scene: &mut Scene, [a, b]: [&str; 2], valve_rows: &[String]) {
    let left = VALVE.0 - 1.5 * SIDE;
    for index in 0..3 {
        block(scene, left + SIDE * f64::from(index), TOP, SIDE, SIDE);
    }
    for y in [TOP - 4.0, BOTTOM + 4.0] {
        lines(scene, &[(left, y), (left + 3.0 * SIDE, y)], Stroke::solid(Role::Axis, 1.2));
    }
    let thin = Stroke::solid(Role::Axis, 1.4);
    let parallel = VALVE.0 - SIDE;
    arrow(scene, (parallel - PORT, BOTTOM), (parallel - PORT, TOP + 1.0), thin);
    arrow(scene, (parallel + PORT, TOP), (parallel + PORT, BOTTOM - 1.0), thin);
    let crossed = VALVE.0 + SIDE;
    arrow(scene, (crossed - PORT, BOTTOM), (crossed + PORT, TOP + 1.0), thin);
    arrow(scene, (crossed - PORT, TOP), (crossed + PORT, BOTTOM - 1.0), thin);
    for x in [VALVE.0 - PORT, VALVE.0 + PORT] {
        for (edge, inner) in [(TOP, TOP + 10.0), (BOTTOM, BOTTOM - 10.0)] {
            lines(scene, &[(x, edge), (x, inner)], thin);
            lines(scene, &[(x - 5.0, inner), (x + 5.0, inner)], thin);
        }
    }
    word(scene, a, (VALVE.0 - PORT - 11.0, TOP - 13.0), Role::Muted);
    word(scene, b, (VALVE.0 + PORT + 11.0, TOP - 13.0), Role::Muted);
    spring(scene, left - 30.0, left, VALVE.1, 7.0, thin);
    torque_motor(scene, left + 3.0 * SIDE);
    rows(scene, valve_rows, (VALVE.0 + 40.0, BOTTOM + 16.0), Anchor::Start, 300.0, 2);
}

/// Box with a diagonal and the arrow of proportional action.
fn torque_motor(scene: &mut Scene, left: f64) {
    let thin = Stroke::solid(Role::Axis, 1.2);
    let (top, right, bottom) = (VALVE.1 - 12.0, VALVE_END, VALVE.1 + 12.0);
    block(scene, left, top, right - left, bottom - top);
    lines(scene, &[(left + 6.0, top), (right - 6.0, bottom)], thin);
    arrow(scene, (left - 1.0, bottom + 9.0), (right + 2.0, top - 9.0), thin);
}

/// Prefilter, comparison and controller from right to left, and the measured force from above.
pub(super) fn controller(scene: &mut Scene, symbol: &ControllerSymbol, schematic: &Schematic) {
    let y = VALVE.1;
    let sum = (CELL, y);
    let g = (sum.0 - 80.0, sum.0 - 44.0);
    arrow(scene, (g.0, y), (VALVE_END + 1.0, y), SIGNAL);
    word(scene, "U_C", (0.5 * (g.0 + VALVE_END), y - 14.0), Role::Text);
    block(scene, g.0, y - 17.0, g.1 - g.0, 34.0);
    word(scene, "G", (0.5 * (g.0 + g.1), y), Role::Text);
    arrow(scene, (sum.0 - 9.0, y), (g.1, y), SIGNAL);
    scene.circle(point(sum.0, sum.1), 9.0, Some(OUTLINE), Some(Fill::solid(Role::Surface)));
    let f = (sum.0 + 38.0, sum.0 + 78.0);
    if symbol.has_prefilter {
        arrow(scene, (f.0, y), (sum.0 + 9.0, y), SIGNAL);
        block(scene, f.0, y - 17.0, f.1 - f.0, 34.0);
        word(scene, "F", (0.5 * (f.0 + f.1), y), Role::Text);
        arrow(scene, (550.0, y), (f.1, y), SIGNAL);
    } else {
        arrow(scene, (550.0, y), (sum.0 + 9.0, y), SIGNAL);
    }
    word(scene, schematic.motion.symbols().reference, (526.0, y - 14.0), Role::Text);
    word(scene, "+", (sum.0 + 16.0, y + 13.0), Role::Text);
    if schematic.load_cell.is_some() {
        lines(scene, &[(CELL, CELL_BOTTOM), (CELL, y - 15.0)], MEASURED);
        head(scene, (CELL, y - 9.0), (0.0, 1.0), SIGNAL.role);
        word(scene, "\u{2212}", (sum.0 - 12.0, y - 17.0), Role::Text);
        word(scene, schematic.motion.symbols().measured, (CELL + 14.0, 172.0), Role::Text);
    }
    rows(scene, &symbol.rows, (550.0, CONTROLLER_ROWS), Anchor::End, 245.0, 3);
}
