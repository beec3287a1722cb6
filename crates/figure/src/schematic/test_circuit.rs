//! Servovalve on its test bench: ports blocked, or joined through a meter.

use super::super::colour::Role;
use super::super::scene::{Anchor, Fill, Scene, point};
use super::super::{Figure, WIDTH, Words};
use super::SupplyKind;
use super::pen::{MEASURED, OUTLINE, PIPE, SIGNAL, arrow, head, lines, rows, word};
use super::symbols::{PORT, TOP, VALVE, VALVE_END, feed, valve_with};

/// Piping of the ports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TestPorts {
    /// Both ports shut, with the meter between pump and valve.
    Blocked,
    /// Ports joined through the meter.
    Joined,
}

/// Valve on its test bench.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TestCircuit {
    /// Piping of the ports.
    pub ports: TestPorts,
    /// Label of the supply, such as `70 bar`; two rows at most.
    pub supply_rows: Vec<String>,
    /// Text next to the ports: the recorded quantities; six rows at most.
    pub rows: Vec<String>,
}

/// Positions of the pipes of the ports.
const SIDES: [f64; 2] = [VALVE.0 - 72.0, VALVE.0 + 72.0];
/// Height of their ends.
const END: f64 = 96.0;
/// Height at which the pipes leave the valve sideways.
const SHOULDER: f64 = 172.0;
/// Height of the gauges.
const GAUGE: f64 = 132.0;
/// Height of the pipe from the supply.
const FEED: f64 = 284.0;

impl TestCircuit {
    /// Draws the diagram.
    pub fn draw(&self, words: &Words) -> Figure {
        let mut scene = Scene::new(WIDTH, 368.0);
        feed(&mut scene, SupplyKind::Pump, &self.supply_rows, "0 bar");
        for ((x, port), outward) in SIDES.into_iter().zip([VALVE.0 - PORT, VALVE.0 + PORT]).zip([-1.0, 1.0]) {
            lines(&mut scene, &[(port, TOP), (port, SHOULDER), (x, SHOULDER), (x, END)], PIPE);
            let name = if outward < 0.0 { "p_A" } else { "p_B" };
            gauge(&mut scene, (x, GAUGE), outward, name);
        }
        let [left, right] = SIDES;
        match self.ports {
            TestPorts::Blocked => {
                for x in SIDES {
                    lines(&mut scene, &[(x - 9.0, END), (x + 9.0, END)], PIPE);
                }
                meter(&mut scene, (VALVE.0 - PORT - 30.0, FEED), "q_leak", (16.0, 24.0));
            }
            TestPorts::Joined => {
                lines(&mut scene, &[(left, END), (right, END)], PIPE);
                meter(&mut scene, (VALVE.0, END), "q", (0.0, -26.0));
            }
        }
        gauge(&mut scene, (VALVE.0 - PORT - 60.0, FEED), -1.0, "p_S");
        valve_with(&mut scene, ["A", "B"], &[]);
        arrow(&mut scene, (VALVE_END + 70.0, VALVE.1), (VALVE_END + 1.0, VALVE.1), SIGNAL);
        word(&mut scene, "U_C", (VALVE_END + 44.0, VALVE.1 - 14.0), Role::Text);
        rows(&mut scene, &self.rows, (right + 76.0, 48.0), Anchor::Start, 205.0, 6);
        words.with_scene(scene)
    }
}

/// Flow meter in a pipe from left to right.
fn meter(scene: &mut Scene, at: (f64, f64), name: &str, label: (f64, f64)) {
    scene.circle(point(at.0, at.1), 12.0, Some(OUTLINE), Some(Fill::solid(Role::Surface)));
    lines(scene, &[(at.0 - 7.0, at.1), (at.0 + 4.0, at.1)], SIGNAL);
    head(scene, (at.0 + 8.0, at.1), (1.0, 0.0), SIGNAL.role);
    word(scene, name, (at.0 + label.0, at.1 + label.1), Role::Text);
}

/// Pressure transducer next to a pipe.
fn gauge(scene: &mut Scene, at: (f64, f64), outward: f64, name: &str) {
    let centre = (at.0 + outward * 34.0, at.1);
    lines(scene, &[at, (centre.0 - outward * 11.0, at.1)], MEASURED);
    scene.circle(point(centre.0, centre.1), 11.0, Some(OUTLINE), Some(Fill::solid(Role::Surface)));
    lines(scene, &[(centre.0 - 4.0, centre.1 + 5.0), (centre.0 + 3.0, centre.1 - 4.0)], OUTLINE);
    let text = (centre.0 + outward * 26.0, centre.1);
    word(scene, name, text, Role::Text);
}
