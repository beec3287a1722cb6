//! Project file: a rig, or any other plant, and its requirements, in one readable text.
//!
//! ```text
//! bytes -> tree -> setting (--set) -> reader <- catalogue: values of named parts
//!                                     |
//!                             Project::visit_system, visit_requirements: each key next to its field
//!                                     |
//!                                     -> validate: the conditions between keys -> Loaded, or a Refusal
//!
//! Project   -> printer -> text                   these visits, written
//!           -> listing -> keys, numbers by path  numbers that `--set` and campaigns may change
//!           -> schema                            for editors
//! bytes, controller -> rewrite -> bytes          all other text unchanged
//! ```
//!
//! Internally, all numbers are SI. Keys are a contract: other tools read them.

mod actuator;
mod alternative;
mod bench;
mod campaign;
pub mod catalogue;
mod catalogue_entry;
mod chosen_lines;
mod controller;
mod design;
mod diagnostic;
mod direction;
mod family;
mod identify;
mod input_signal;
mod limit;
mod linear;
mod listing;
mod load_case;
mod loaded;
mod measured;
mod named_files;
mod open_rig;
mod operating_point;
mod plant;
mod printer;
mod published;
mod read;
mod read_again;
mod reader;
mod recorded;
mod rewrite;
mod scenario;
mod schema;
mod sensor;
mod setting;
mod simulation;
mod sizing;
pub mod source;
mod specification;
mod text;
mod toml_text;
mod tree;
mod uncertainty;
mod unit_of_key;
mod validate;
mod verification;
mod written_units;

pub use actuator::{ChamberValve, DeclaredActuator};
pub use alternative::*;
pub use bench::*;
pub use campaign::*;
pub use chosen_lines::*;
pub use controller::*;
pub use design::*;
pub use diagnostic::*;
pub use direction::*;
pub use family::*;
pub use identify::*;
pub use input_signal::{Amplitudes, InputSignal, Multisine};
pub use limit::*;
pub use linear::*;
pub use listing::KeyEntry;
pub use load_case::*;
pub use loaded::*;
pub use measured::*;
pub use open_rig::OpenRig;
pub use operating_point::DeclaredOperatingPoint;
pub use phea_hydraulics::accumulator::{
    AdjustmentKind, DeclaredAccumulator, DeclaredAdjustment, DeclaredGasValve, DeclaredNeck, GasAtOne,
    GasTemperatures,
};
pub use phea_hydraulics::cross_port::{
    CrossPortKind, DeclaredCapacity, DeclaredCrossPort, DeclaredOrifice, DeclaredRestrictor, OrificeSize,
};
pub use phea_hydraulics::cylinder::{DeclaredCylinder, DeclaredMotor, DeclaredStage};
pub use phea_hydraulics::fluid::DeclaredFluid;
pub use phea_hydraulics::force_sensor::DeclaredForceSensor;
pub use phea_hydraulics::friction::{DeclaredFriction, RetractingFriction};
pub use phea_hydraulics::line::{
    Component, DeclaredLine, DeclaredLines, DeclaredPipe, ElasticWall, HoseExpansion, HoseProperties,
    LineMotion, LineSegments, LineVolume, LineWall,
};
pub use phea_hydraulics::linkage::{
    CylinderTriangle, DeclaredLinkage, DeclaredLinks, DeclaredWeight, FourBarBranch, LinkageKind,
};
pub use phea_hydraulics::load::Load;
pub use phea_hydraulics::power_unit::{DeclaredSupply, Pump, SupplyModel};
pub use phea_hydraulics::series::{DeclaredSeries, DeclaredSpring, DeclaredTransmission, SpringCoil};
pub use phea_hydraulics::servovalve::{
    LEAKAGE_MODELS, NullLeakage, RatedFlow, Valve, ValveCoefficients, ValveLap,
};
pub use phea_hydraulics::velocity_sensor::DeclaredVelocitySensor;
pub use phea_table::{DeclaredMisfit, LineCost, PartCost};
pub use plant::*;
pub use published::*;
pub use read::sha256;
pub use read::{keys, print, read};
pub use read_again::{read_alternative, read_load_case, refused, refused_alternative};
pub use recorded::*;
pub use scenario::*;
pub use schema::schema;
pub use sensor::*;
pub use simulation::*;
pub use sizing::*;
pub use specification::*;
pub use uncertainty::*;
pub use unit_of_key::unit_of_key;
pub use verification::*;

pub(crate) use input_signal::InputUnit;
pub use phea_table::{
    AcceptedRange, Formula, FormulaError, Key, Motions, Ratio, Variable, once_read, word_of,
};
pub(crate) use phea_table::{TableNumber, Visitor, key, plain};
pub(crate) use reader::Reader;
pub use rewrite::{RewriteError, snippet, with_elements, with_laws, with_line_model, with_pressure_feedback};
pub use text::{Findings, Place, RawFinding};
pub use tree::{Entry, TreeNode, Value as TreeValue, read as read_tree, value_or_finding};
pub use written_units::WrittenUnits;

use phea_dynamics::portable;
use phea_quantity::{RATIO, Units};

/// Commented project as a starting point.
pub const STARTER: &str = include_str!("starter.toml");

/// Declared project. It has exactly one of `actuator`, `plant` and measured plants in `family`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Project {
    /// Folder to which paths of other files are relative: the project file's own path up to its
    /// name. Not a key.
    pub folder: String,
    /// Display units of its quantities: those of its text, otherwise the customary ones. Not a key.
    pub units: Units,
    /// Title for people, one line.
    pub title: String,
    /// Hydraulic actuator and its load.
    pub actuator: Option<DeclaredActuator>,
    /// Other plant, as a transfer function.
    pub plant: Option<DeclaredPlant>,
    /// Examined plants; if absent, the grid of `uncertainty`.
    pub family: Option<DeclaredFamily>,
    /// Dynamics between the controlled output and the controller; if absent, 1.
    pub sensor: Option<Sensor>,
    /// Requirements for sizing the compliant component.
    pub sizing: Option<DeclaredSizing>,
    /// Operating point of the linear model.
    pub operating_point: DeclaredOperatingPoint,
    /// Parameters of the linear model that are stated directly.
    pub linear: Linear,
    /// Uncertain numbers, in file order.
    pub uncertainty: Vec<Uncertain>,
    /// Numbers that are uncertain together, in file order.
    pub directions: Vec<UncertaintyDirection>,
    /// Requirements on the closed loop, in file order.
    pub specifications: Vec<DeclaredSpecification>,
    /// Controller to be verified; if absent or without a transfer function, it is designed.
    pub controller: Option<DeclaredController>,
    /// Prefilter to be verified; if absent, it is designed.
    pub prefilter: Option<Prefilter>,
    /// Settings of the design; defaults if absent.
    pub design: Option<DeclaredDesign>,
    /// Settings of the verification; defaults if absent.
    pub verification: Option<DeclaredVerification>,
    /// Simulated scenarios.
    pub scenarios: Vec<Scenario>,
    /// Settings of the simulation.
    pub simulation: Simulation,
    /// Variations of a Monte Carlo campaign.
    pub campaign: Option<Campaign>,
    /// Tests of the servovalve; defaults if absent.
    pub bench: Bench,
    /// Recordings for the identification of the servovalve.
    pub identify: Option<Identify>,
    /// Alternatives with other values, for comparison, in file order.
    pub alternatives: Vec<Alternative>,
    /// Other values under which the project and its alternatives are judged again, in file order.
    pub load_cases: Vec<LoadCase>,
}

impl Project {
    /// Tolerance of the verdict, if stated, dB.
    pub fn tolerance_db(&self) -> Option<f64> {
        let declared = self.verification.as_ref()?;
        declared.tolerance.map(|factor| 20.0 * portable::log10(factor))
    }

    /// Visits the tables of the system: the actuator or the plant.
    fn visit_system<V: Visitor>(&mut self, v: &mut V) {
        let mut schema = 1;
        v.count(key("schema", &RATIO, "Version of this format: 1.").at_least(1.0).at_most(1.0), &mut schema);
        let mut title = (!self.title.is_empty()).then(|| std::mem::take(&mut self.title));
        v.text(plain("title", "One line for people."), &mut title, false);
        self.title = title.unwrap_or_default();
        v.table(plain("plant", "Any plant but an actuator."), &mut self.plant, DeclaredPlant::visit);
        v.part(&mut self.actuator, DeclaredActuator::visit);
    }

    /// Visits the requirements on the system.
    fn visit_requirements<V: Visitor>(&mut self, v: &mut V) {
        let k = plain("operating_point", "Where the linear model is taken.");
        v.table_or_default(k, &mut self.operating_point, DeclaredOperatingPoint::visit);
        let k = plain("linear", "Parameters of the linear model, set outright.");
        v.table_or_default(k, &mut self.linear, Linear::visit);
        v.table(
            plain("sizing", "What the compliance is sized for."),
            &mut self.sizing,
            DeclaredSizing::visit,
        );
        let k = plain("uncertainty", "Uncertain numbers and their grids.");
        Uncertain::visit_all(k, &mut self.uncertainty, v);
        let k = plain("uncertainty_direction", "Numbers that are uncertain together.");
        v.tables(k, &mut self.directions, UncertaintyDirection::visit);
        v.table(plain("family", "Which plants are examined."), &mut self.family, DeclaredFamily::visit);
        v.table(plain("sensor", "Dynamics of the sensor."), &mut self.sensor, Sensor::visit);
        let k = plain("specification", "What the closed loop must meet.");
        v.tables(k, &mut self.specifications, DeclaredSpecification::visit);
        let k = plain("controller", "Given, to be verified; absent, to be designed.");
        v.table(k, &mut self.controller, DeclaredController::visit);
        let k = plain("prefilter", "Given, to be verified; absent, to be designed.");
        v.table(k, &mut self.prefilter, Prefilter::visit);
        v.table(plain("design", "How a controller is designed."), &mut self.design, DeclaredDesign::visit);
        let k = plain("verification", "How a controller is judged.");
        v.table(k, &mut self.verification, DeclaredVerification::visit);
        v.tables(plain("scenario", "What is simulated."), &mut self.scenarios, Scenario::visit);
        let k = plain("simulation", "How exactly scenarios are simulated.");
        v.table_or_default(k, &mut self.simulation, Simulation::visit);
        v.table(plain("campaign", "What a campaign varies."), &mut self.campaign, Campaign::visit);
        let k = plain("bench", "How the servovalve is tested.");
        v.table_or_default(k, &mut self.bench, Bench::visit);
        let k = plain("identify", "What the servovalve is identified from.");
        v.table(k, &mut self.identify, Identify::visit);
        let k = plain("alternative", "The project with other values, for `phea alternatives`.");
        v.tables(k, &mut self.alternatives, Alternative::visit);
        let k = plain("load_case", "Other values under which all alternatives are judged again.");
        v.tables(k, &mut self.load_cases, LoadCase::visit);
    }
}
