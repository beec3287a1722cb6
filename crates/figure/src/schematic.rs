//! Hydraulic circuit with its controller, in symbols after ISO 1219-1, with the words of a project.
//!
//! Fixed positions, variable symbols and texts: cylinder, moving mass, load cell and environment on
//! top, the lines below them, then servovalve and controller, then supply and tank. Every text
//! comes from the caller and is cut to the space available.

mod cross_port;
mod gas;
mod lever;
mod mechanics;
mod motor;
mod pen;
mod port_valves;
mod symbols;
mod test_circuit;

pub use test_circuit::{TestCircuit, TestPorts};

use phea_quantity::MotionKind;

use super::scene::Scene;
use super::{Figure, WIDTH, Words};

/// Supply of the valve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SupplyKind {
    /// Source of constant pressure.
    ConstantPressure,
    /// Pump of limited flow.
    Pump,
}

/// Connection of valve and chamber.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineKind {
    /// Flexible line.
    Hose,
    /// Rigid line.
    Pipe,
}

/// Line between valve and chamber.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LineSymbol {
    /// Kind.
    pub kind: LineKind,
    /// Accumulator at the chamber, if there is one.
    pub accumulator: Option<AccumulatorSymbol>,
    /// True if a relief valve joins the chamber to the tank.
    pub has_relief: bool,
    /// True if a check valve joins the tank to the chamber.
    pub has_check: bool,
    /// Text rows, such as `hose 12.7 mm` and `1.5 m`; [`LINE_ROWS`] at most.
    pub rows: Vec<String>,
}

impl LineSymbol {
    /// Line from the valve to a chamber without further parts.
    pub fn new(kind: LineKind, rows: Vec<String>) -> LineSymbol {
        LineSymbol { kind, accumulator: None, has_relief: false, has_check: false, rows }
    }
}

/// Largest number of text rows of a line.
pub const LINE_ROWS: usize = 6;

/// Accumulator at a chamber.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AccumulatorSymbol {
    /// Accumulator with fixed gas.
    Fixed,
    /// Accumulator with gas that is adjusted in operation: an arrow through it.
    Adjusted,
    /// Accumulator with an adjusted valve before it: an arrow through the valve.
    ThroughValve,
}

/// Valve between the chambers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CrossPortSymbol {
    /// True if a capacity is in series with it: there is no flow at rest.
    pub has_capacity: bool,
    /// Text below it, such as `orifice` and `0.8 mm`; two short rows at most, shown unless an
    /// accumulator occupies the space.
    pub rows: Vec<String>,
}

/// Rods of the cylinder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rods {
    /// Rods on both sides: a symmetric cylinder.
    Both,
    /// Rod towards the load only.
    TowardsLoad,
}

/// Joint behind the rod's end, about which the load turns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LinkageSymbol {
    /// Text next to the lever, such as `four-bar`, `arm r`, `49.8 mm`; three short rows at most.
    pub rows: Vec<String>,
}

/// Environment on which the rod acts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Environment {
    /// Prescribed motion; drawn with the arrow of x_L.
    PrescribedMotion,
    /// Fixed wall.
    Wall,
    /// Mass on a spring and a damper.
    SpringMassDamper,
}

/// Element between load cell and environment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SeriesSymbol {
    /// Kind of element.
    pub kind: SeriesKind,
    /// Text below it, such as its stiffness.
    pub words: String,
}

/// Kinds of elements between load cell and environment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SeriesKind {
    /// Spring.
    Spring,
    /// Spring with a damper in parallel.
    DampedSpring,
    /// Two pistons with a line between them.
    Transmission,
}

/// Blocks of the control loop.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ControllerSymbol {
    /// True if there is a prefilter F.
    pub has_prefilter: bool,
    /// Text below the blocks, such as `G = 0.001 (s + 8)/s`; three rows at most.
    pub rows: Vec<String>,
}

/// Rig with its controller, in symbols.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Schematic {
    /// Supply.
    pub supply: SupplyKind,
    /// Label of the supply, such as `70 bar`; two rows at most.
    pub supply_rows: Vec<String>,
    /// Label of the tank, such as `0 bar`.
    pub tank: String,
    /// Text of the valve, such as its model; two rows at most.
    pub valve_rows: Vec<String>,
    /// Line of chamber A.
    pub line_a: LineSymbol,
    /// Line of chamber B.
    pub line_b: LineSymbol,
    /// Valve between the chambers, if there is one.
    pub cross_port: Option<CrossPortSymbol>,
    /// Motion of the rig; a motor in place of the cylinder is drawn with its own symbols.
    pub motion: MotionKind,
    /// Rods.
    pub rods: Rods,
    /// Stages of a telescopic piston after the first; [`STAGES`] of them are drawn.
    pub further_stages: usize,
    /// True if chamber B faces the load; otherwise chamber A does.
    pub load_at_b: bool,
    /// Text above the cylinder, such as `50/22 mm, stroke 500 mm`.
    pub cylinder: String,
    /// Text above the moving mass, such as `13.1 kg`.
    pub mass: String,
    /// Text of the load cell, such as `20 MN/m`; two rows at most. If absent, the rod holds the
    /// environment directly.
    pub load_cell: Option<Vec<String>>,
    /// Spring between load cell and environment, if there is one.
    pub series: Option<SeriesSymbol>,
    /// Joint between these and the environment, if there is one.
    pub linkage: Option<LinkageSymbol>,
    /// Environment.
    pub environment: Environment,
    /// Text below the environment, such as its stiffness; two rows at most.
    pub environment_rows: Vec<String>,
    /// Control loop, if there is one.
    pub controller: Option<ControllerSymbol>,
}

/// Largest number of further stages of a telescopic piston that are drawn nested; the text states
/// the true number.
pub const STAGES: usize = 3;

impl Schematic {
    /// Draws the diagram.
    pub fn draw(&self, words: &Words) -> Figure {
        let mut scene = Scene::new(WIDTH, self.height());
        symbols::supply(&mut scene, self);
        symbols::working_lines(&mut scene, self);
        if let Some(symbol) = &self.cross_port {
            let has_room = [&self.line_a, &self.line_b].iter().all(|line| line.accumulator.is_none());
            cross_port::cross_port(&mut scene, symbol, has_room);
        }
        symbols::valve(&mut scene, self);
        if self.motion.is_rotary() {
            motor::motor(&mut scene, self);
        } else {
            mechanics::cylinder(&mut scene, self);
        }
        mechanics::load(&mut scene, self);
        if let Some(controller) = &self.controller {
            symbols::controller(&mut scene, controller, self);
        }
        words.with_scene(scene)
    }

    /// Height down to the supply or the text of the controller.
    fn height(&self) -> f64 {
        let rows = self.controller.as_ref().map_or(0, |controller| controller.rows.len().min(3));
        let words = symbols::CONTROLLER_ROWS + pen::ROW * rows as f64 + 4.0;
        let supply: f64 = match self.supply {
            SupplyKind::ConstantPressure => 340.0,
            SupplyKind::Pump => 368.0,
        };
        supply.max(words)
    }
}
