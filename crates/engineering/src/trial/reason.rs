//! Findings on the runs of a machine against its linear loop, as facts.

use super::run::Leg;
use crate::plant_names::NamedPlant;
use crate::rig::RigError;
use crate::simulate::{RunStatus, SimulateError};
use crate::specification::NamedSpecification;

/// A simulated machine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TrialMachine {
    /// The rig as declared.
    Declared,
    /// The rig with waves in its lines.
    WithWaves,
    /// The worst plant of the audit, made into a rig.
    WorstPlant(WorstOf),
    /// The worst of the corners of the box and of the plants inside it.
    WorstOfBox {
        /// Number of simulated corners.
        corners: usize,
        /// Number of simulated plants inside the box.
        inside: usize,
    },
}

/// Criterion by which a plant is the worst.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WorstOf {
    /// A specification.
    Specification(NamedSpecification),
    /// The requirement in time of a specification.
    InTime(NamedSpecification),
    /// The required step.
    RequiredStep,
}

/// Result of a run compared with the linear loop, and the cause of a difference.
#[derive(Clone, Debug, PartialEq)]
pub struct TrialReason {
    /// Finding on the run.
    pub finding: TrialFinding,
    /// Cause of a difference, if it was searched and found.
    pub cause: Option<DifferenceCause>,
}

impl From<TrialFinding> for TrialReason {
    fn from(finding: TrialFinding) -> TrialReason {
        TrialReason { finding, cause: None }
    }
}

/// Result of a run compared with the linear loop.
#[derive(Clone, Debug, PartialEq)]
pub enum TrialFinding {
    /// Neither the linear loop nor the machine settles.
    NeitherSettles {
        /// Overshoots of the machine and of the linear loop, percent, if they differ.
        overshoots: Option<[f64; 2]>,
    },
    /// The simulation does not start.
    NotStarted(SimulateError),
    /// The simulation diverges from this time on, s.
    Diverges(f64),
    /// The run ended early.
    StoppedEarly {
        /// Time of the end, s.
        time: f64,
        /// Status of the run.
        status: RunStatus,
    },
    /// The force does not settle.
    Unsettled {
        /// Step after which the force does not settle.
        leg: Leg,
        /// Final behaviour; `None` if it is not known.
        end: Option<UnsettledEnd>,
    },
    /// The machine overshoots.
    Overshoots {
        /// Overshoot, percent of the step.
        percent: f64,
        /// Step with that overshoot.
        leg: Leg,
        /// Overshoot of the linear loop, percent; `None` if it is not known.
        linear: Option<f64>,
        /// Remark on the run.
        note: OvershootNote,
    },
    /// The settling time differs.
    Settles {
        /// Settling time of the machine, s.
        machine: f64,
        /// Settling time of the linear loop, s.
        linear: f64,
        /// Required settling time that only the machine exceeds, s; `None` if the difference itself
        /// counts.
        required: Option<f64>,
    },
}

/// Final behaviour of a force that does not settle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum UnsettledEnd {
    /// Rest at a distance from the reference.
    AtRest {
        /// Force, N.
        force: f64,
        /// Distance from the reference, percent of the step.
        off_percent: f64,
    },
    /// Oscillation between these forces, N.
    Swings([f64; 2]),
}

/// Remark on a run that overshoots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OvershootNote {
    /// No further remark.
    Nothing,
    /// The limit on |L/(1+L)| permits no loop to overshoot so far.
    BeyondLimit,
    /// The force does not settle and swings between these forces, N.
    Swings([f64; 2]),
    /// No solver can determine the result.
    Undetermined,
    /// The run reaches this limit or end stop: the name of an occurrence.
    Meets(&'static str),
}

/// Cause of a difference between a machine and its linear loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DifferenceCause {
    /// Waves of the lines.
    Waves {
        /// Frequency at which a line is a quarter wave long, rad/s.
        quarter_wave: f64,
        /// Declaration that adds damping by the wall of these lines; `None` if there is none.
        wall: Option<DampingWall>,
    },
    /// Something other than waves: with lumped lines these steps differ as well.
    OtherThanWaves,
    /// Noise of the sensors.
    Noise,
}

/// Keys that declare the damping of a hose's wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DampingWall {
    /// `line.relaxation_time`.
    RelaxationTime,
    /// `line.model = "segments"` with `line.relaxation_time`.
    SegmentsWithRelaxationTime,
}

/// Plant or step that a trial does not simulate.
#[derive(Clone, Debug, PartialEq)]
pub enum NotDriven {
    /// A plant without a rig.
    Plant {
        /// Criterion by which the plant is the worst.
        of: WorstOf,
        /// Plant without a rig.
        plant: NamedPlant,
        /// Reason why it has no rig.
        reason: NoRig,
    },
    /// A smaller step of a scenario, from one force to the other, N.
    SmallerStep([f64; 2]),
}

/// Reason why a plant has no rig.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoRig {
    /// The plant is in motion at its operating point.
    #[error("a machine is tried from rest, and this plant is one in motion")]
    InMotion,
    /// A number of the plant does not exist in the rig.
    #[error("no rig is known with another `{0}`")]
    UnknownNumber(String),
    /// No rig was found with these parameters.
    #[error("no rig was found whose linear model has these parameters: {}", missed(.0))]
    Missed(Vec<MissedParameter>),
    /// The rig cannot be computed.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// A parameter does not exist in the linear model.
    #[error("`{0}` is not a parameter")]
    UnknownParameter(String),
    /// No number of the rig determines a parameter.
    #[error("nothing in the rig moves `{0}`")]
    Fixed(String),
    /// No number of the rig determines a parameter without affecting others.
    #[error("nothing in the rig moves `{0}` alone")]
    Coupled(String),
    /// The project declares no rig.
    #[error("there is no rig")]
    NoActuator,
}

/// A parameter that the nearest rig does not have.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{name} comes to {found:.4e} and not to {wanted:.4e}")]
pub struct MissedParameter {
    /// Name of the parameter.
    pub name: String,
    /// Value of the nearest rig, SI.
    pub found: f64,
    /// Value of the plant, SI.
    pub wanted: f64,
}

fn missed(parameters: &[MissedParameter]) -> String {
    parameters.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
}
