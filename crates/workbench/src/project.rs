//! The project file: a rig, or any other plant, and what is wanted of it, in one readable text.
//!
//! Inside, everything is SI. Keys are a contract: other tools read them.

mod campaign;
mod controller;
mod cylinder;
mod diagnostic;
mod environment;
mod fluid;
mod formula;
mod interval;
mod key;
mod line;
mod linear;
mod plant;
mod scenario;
mod sizing;
mod specification;
mod uncertainty;
mod valve;
mod visitor;

pub use campaign::*;
pub use controller::*;
pub use cylinder::*;
pub use diagnostic::*;
pub use environment::*;
pub use fluid::*;
pub use formula::*;
pub use interval::*;
pub use key::{Key, Range};
pub use line::*;
pub use linear::*;
pub use plant::*;
pub use scenario::*;
pub use sizing::*;
pub use specification::*;
pub use uncertainty::*;
pub use valve::*;

use key::{key, plain};
use visitor::Visitor;

use crate::quantity::RATIO;

/// A project as it was declared. Exactly one of `actuator` and `plant` is there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Project {
    /// One line for people.
    pub title: String,
    /// The hydraulic actuator and what it works against.
    pub actuator: Option<Actuator>,
    /// Any other plant, as a transfer function.
    pub plant: Option<Plant>,
    /// A family of plants that is not a grid.
    pub family: Option<Family>,
    /// What the compliant component is sized for.
    pub sizing: Option<Sizing>,
    /// Where the linear model is taken.
    pub operating_point: OperatingPoint,
    /// Parameters of the linear model that are set outright.
    pub linear: Linear,
    /// Uncertain numbers, in file order.
    pub uncertainty: Vec<Uncertain>,
    /// What the closed loop must meet, in file order.
    pub specifications: Vec<Specification>,
    /// Given, to be verified; absent, to be designed.
    pub controller: Option<Controller>,
    /// Given, to be verified; absent, to be designed.
    pub prefilter: Option<Prefilter>,
    /// What is simulated.
    pub scenarios: Vec<Scenario>,
    /// What a Monte Carlo campaign varies.
    pub campaign: Option<Campaign>,
}

/// The hydraulic actuator and what it works against.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Actuator {
    /// The oil.
    pub fluid: Fluid,
    /// The pressure supply.
    pub supply: Supply,
    /// The servovalve.
    pub valve: Valve,
    /// The cylinder.
    pub cylinder: Cylinder,
    /// The lines between valve and cylinder.
    pub line: Lines,
    /// The load cell.
    pub force_sensor: ForceSensor,
    /// What the force acts on.
    pub load: Load,
}

/// A project that was read, and what belongs to the reading rather than to the rig.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// What was declared, with settings applied, catalogue values and defaults filled in.
    pub project: Project,
    /// What is doubtful without being wrong.
    pub warnings: Vec<Diagnostic>,
    /// Of the file's bytes, in hexadecimal.
    pub sha256: String,
    /// The `path=value` texts that were applied, as given.
    pub settings: Vec<String>,
    /// The catalogue files a value came from: those of the project's own and `built-in:NAME`.
    pub catalogue_files: Vec<String>,
    /// Where every number that is not simply declared in the file came from, in path order.
    pub provenance: Vec<Provenance>,
}

/// Where a number came from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Provenance {
    /// Dotted path, such as `valve.nominal_flow`.
    pub path: String,
    /// Who said it.
    pub origin: Origin,
}

/// Who said a number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The project file.
    Project,
    /// A `--set`, quoted.
    Setting(String),
    /// The catalogue, with the source of the number.
    Catalogue {
        /// Name of the entry.
        name: String,
        /// Author, title and table.
        source: String,
    },
    /// Nobody: it is the default of the key.
    Default,
}
