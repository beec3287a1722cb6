//! The hydraulic circuit with its controller, in symbols after ISO 1219-1, from the words of a
//! project.
//!
//! Fixed places, variable symbols and texts: cylinder, moving mass, load cell and environment on
//! top, the lines below them, then servovalve and controller, then supply and tank. Every text
//! comes from the caller and is cut to its place.

mod cross_port;
mod gas;
mod lever;
mod mechanics;
mod motor;
mod pen;
mod symbols;
mod test_circuit;

pub use test_circuit::{TestCircuit, TestPorts};

use phea_quantity::MotionKind;

use super::scene::Scene;
use super::{Figure, WIDTH, Words};

/// What feeds the valve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SupplyKind {
    /// A source of constant pressure.
    ConstantPressure,
    /// A pump of limited flow.
    Pump,
}

/// What joins valve and chamber.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineKind {
    /// A flexible line.
    Hose,
    /// A rigid line.
    Pipe,
}

/// A line between valve and chamber.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LineSymbol {
    /// Kind.
    pub kind: LineKind,
    /// The accumulator at the chamber, where there is one.
    pub accumulator: Option<AccumulatorSymbol>,
    /// Words, one row each, such as `hose 12.7 mm` and `1.5 m`; [`LINE_ROWS`] at most.
    pub rows: Vec<String>,
}

/// Rows of words that a line has room for.
pub const LINE_ROWS: usize = 6;

/// An accumulator at a chamber.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AccumulatorSymbol {
    /// Its gas stays.
    Fixed,
    /// Its gas is adjusted in operation: an arrow through it.
    Adjusted,
    /// A valve between it and the chamber is adjusted: an arrow through that.
    BehindValve,
}

/// A valve between the chambers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CrossPortSymbol {
    /// A capacity in series with it: nothing flows at rest.
    pub has_capacity: bool,
    /// Words below it, such as `orifice` and `0.8 mm`; two short rows at most, shown where no
    /// accumulator has its place there.
    pub rows: Vec<String>,
}

/// Rods of the cylinder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rods {
    /// On both sides: a symmetric cylinder.
    Both,
    /// Towards the load only.
    TowardsLoad,
}

/// A joint behind the rod's end, about which the load turns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LinkageSymbol {
    /// Words beside the lever, such as `four-bar`, `arm r`, `49.8 mm`; three short rows at most.
    pub rows: Vec<String>,
}

/// What the rod pushes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Environment {
    /// A place whose motion is given; drawn with the arrow of x_L.
    PrescribedMotion,
    /// A wall that stands still.
    Wall,
    /// A mass on a spring and a damper.
    SpringMassDamper,
}

/// What lies between load cell and environment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SeriesSymbol {
    /// What it is.
    pub kind: SeriesKind,
    /// Words below it, such as its stiffness.
    pub words: String,
}

/// Kinds of what lies between load cell and environment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SeriesKind {
    /// A spring.
    Spring,
    /// A spring with a damper parallel to it.
    DampedSpring,
    /// Two pistons with a line between them.
    Transmission,
}

/// Blocks of the control loop.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ControllerSymbol {
    /// There is a prefilter F.
    pub has_prefilter: bool,
    /// Words below the blocks, such as `G = 0.001 (s + 8)/s`; three rows at most.
    pub rows: Vec<String>,
}

/// A rig with its controller, in symbols.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Schematic {
    /// Supply.
    pub supply: SupplyKind,
    /// Label of the supply, such as `70 bar`; two rows at most.
    pub supply_rows: Vec<String>,
    /// Label of the tank, such as `0 bar`.
    pub tank: String,
    /// Words of the valve, such as its model; two rows at most.
    pub valve_rows: Vec<String>,
    /// Line of chamber A.
    pub line_a: LineSymbol,
    /// Line of chamber B.
    pub line_b: LineSymbol,
    /// A valve between the chambers, where there is one.
    pub cross_port: Option<CrossPortSymbol>,
    /// A motor in place of the cylinder is drawn as one, with the symbols of one.
    pub motion: MotionKind,
    /// Rods.
    pub rods: Rods,
    /// Stages of a telescopic piston after the first; [`STAGES`] of them are drawn.
    pub further_stages: usize,
    /// True if chamber B faces the load; otherwise chamber A does.
    pub load_beside_b: bool,
    /// Word above the cylinder, such as `50/22 mm, stroke 500 mm`.
    pub cylinder: String,
    /// Word above the moving mass, such as `13.1 kg`.
    pub mass: String,
    /// Words of the load cell, such as `20 MN/m`; two rows at most. Absent: the rod holds the
    /// environment itself.
    pub load_cell: Option<Vec<String>>,
    /// A spring between load cell and environment, where there is one.
    pub series: Option<SeriesSymbol>,
    /// A joint between these and the environment, where there is one.
    pub linkage: Option<LinkageSymbol>,
    /// Environment.
    pub environment: Environment,
    /// Words below the environment, such as its stiffness; two rows at most.
    pub environment_rows: Vec<String>,
    /// Control loop, where there is one.
    pub controller: Option<ControllerSymbol>,
}

/// Further stages of a telescopic piston that are drawn one in another; the words say how many
/// there are.
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

    /// As low as the supply or the words of the controller reach.
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
