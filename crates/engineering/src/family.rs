//! The family of plants for robust design, from a project.

mod formula;
mod gain_slopes;
mod hill;
mod hydraulic;
mod in_motion;
mod jumps;
mod measured;
mod moved;
mod null_crossing;
mod null_sides;
mod region;
mod shut_gas;
mod start;
mod uncertain;
mod visited;
mod visited_box;

use phea_dynamics::closed_loop::ClosedLoop;
use phea_dynamics::uncertain_plant::{UncertainParameter, UncertainPlant, UncertainPlantError};
use phea_hydraulics::actuator::ActuatorError;
use phea_hydraulics::line::LineError;
use phea_hydraulics::operating_point::OperatingPointError;
use phea_qft::family::{Family, MeasurementError};

use crate::project::{FormulaError, Project, Refusal};
use crate::quantity::significant;
use crate::rig::{OfMotion, RigError};
use crate::setup::Setup;
use crate::source::Source;

pub(crate) use gain_slopes::gain_slopes;
pub use shut_gas::{NumberAt, ShutGas, shut_gas};
pub use visited_box::{Extreme, VisitedRange, visited_box};

/// Reason why a project has no uncertain plant.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ProjectFamilyError {
    /// The rig cannot be computed.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// A parameter of the linear model is stated directly, outside its range.
    #[error(
        "`linear.{name}` = {value:e} lies outside of its range in [uncertainty], {minimum:e} to {maximum:e}: widen the range, or take the number out of [linear]"
    )]
    Linear {
        /// Name of the parameter.
        name: String,
        /// Value in `[linear]`, SI.
        value: f64,
        /// Lower end of the range, SI.
        minimum: f64,
        /// Upper end of the range, SI.
        maximum: f64,
    },
    /// The box or its coefficients are empty.
    #[error("[uncertainty]: {0}")]
    Plant(#[from] UncertainPlantError),
    /// The members are not plants of the box.
    #[error("[uncertainty]: {0}")]
    Members(#[from] phea_qft::family::FamilyError),
    /// The dead time of a member is negative, or not a number.
    #[error("[plant] `delay` is {delay_s} s at {member}")]
    Delay {
        /// Value of the formula, s.
        delay_s: f64,
        /// The member's parameters with their values.
        member: String,
    },
    /// Files of measured responses cannot be read, with every place.
    #[error("[family] `measured` cannot be taken as it is\n{0}")]
    Measurement(Box<Refusal>),
    /// Measured responses do not form a family.
    #[error("[family] `measured`: {0}")]
    Measured(#[from] MeasurementError),
    /// A member has no polynomials but a coefficient that supplies energy: the number of its
    /// unstable poles is not known.
    #[error(
        "with lines in motion, or a load velocity fed forward late, every coefficient of friction, leakage, valve and load must be zero or \
         more, or the plant's own stability is not known: {member}"
    )]
    NotPassive {
        /// The member's parameters with their values.
        member: String,
    },
    /// The model of a line does not fit a member.
    #[error("[line] model: {error}, at {member}")]
    Line {
        /// Fault of the line.
        error: LineError,
        /// The member's parameters with their values.
        member: String,
    },
    /// Load motion is limited, but a measured plant does not contain that path.
    #[error("\"load_motion\" needs the columns `load_motion_...`, which {0} lacks")]
    LoadMotion(String),
    /// The text of the plant is not a ratio of polynomials.
    #[error("[plant]: {message}", message = .0.message)]
    Formula(FormulaError),
    /// A plant of the box has no operating point, or none that is known to be that of the rig.
    #[error("no operating point at {member}: {reason}")]
    OperatingPoint {
        /// Parameters that determine it, with their values.
        member: String,
        /// Names of these parameters.
        numbers: Vec<String>,
        /// Reason why it does not exist.
        reason: NoOperatingPoint,
    },
    /// The flow of the pump does not reach the whole region.
    #[error(
        "[family.operating_region] `velocity`: the pump gives {least} to {most}, and the nominal velocity is {nominal}"
    )]
    Region {
        /// Least velocity that the pump supplies, with its unit.
        least: String,
        /// Greatest velocity that the pump supplies, with its unit.
        most: String,
        /// Nominal velocity, with its unit.
        nominal: String,
    },
    /// No formula relates an uncertain number to the linear model.
    #[error("[uncertainty] `{path}`: {reason}")]
    Path {
        /// Path of the number.
        path: String,
        /// Reason why it does not affect the linear model.
        reason: NoEffect,
    },
}

/// Reason why a plant of the box has no operating point.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoOperatingPoint {
    /// The components do not make an actuator.
    #[error(transparent)]
    Actuator(#[from] ActuatorError),
    /// No pressures balance.
    #[error("{0}")]
    Unbalanced(OfMotion<OperatingPointError>),
    /// The recorded pressures are not those that balance.
    #[error(
        "the pressures recorded for it miss those that balance by {} % of the supply's",
        significant(100.0 * .fraction, 2)
    )]
    Missed {
        /// Sum of the errors of both pressures as fractions of the supply pressure, and of the
        /// command as a fraction of the nominal voltage.
        fraction: f64,
    },
}

/// Reason why an uncertain number does not affect the linear model.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoEffect {
    /// The project states a parameter of the linear model that would follow from the number.
    #[error("what the project states goes before what would follow from it")]
    StatedInstead,
    /// The number affects only the waves in the lines, which are those of the declared oil.
    #[error(
        "it does not enter the linear model but through the waves in the lines, which are those of the declared oil: verify other oils one by one, `--set {path}=...`"
    )]
    OnlyInWaves {
        /// Path of the number.
        path: String,
    },
    /// No equation of the linear model contains the number.
    #[error("it does not enter the linear model")]
    NotInModel,
}

/// Family of a project: the linear model of its actuator, or the transfer function that it states,
/// over the box of `[uncertainty]`; or the measured plants. Plants with waves in their lines have
/// no polynomials.
///
/// `[family]` states which plants of the box are examined: its `grid`, its `vertices`, points at
/// `random`, explicit `cases`, or several of them together; the grid if it states nothing. If only
/// `cases` are given, nothing between them belongs to the family.
///
/// # Errors
/// [`ProjectFamilyError`] if there is no rig, an uncertain name is not a parameter of the plant, or
/// a member is outside the box.
///
/// # Example
/// ```
/// use phea_qft::family::Family;
/// use phea_project::source::Memory;
/// let text = "schema = 1\n[plant]\nnumerator = \"k\"\ndenominator = \"s\"\n\
///             [uncertainty]\nk = { nominal = 2, minimum = 1, maximum = 4, points = 3, spacing = \"log\" }\n";
/// let source = Memory::default().with("servo.toml", text);
/// let project = phea_project::read(&source, "servo.toml", &[], &[])?.project;
/// let setup = phea_engineering::setup::Setup::new(&project)?;
/// let Family::Uncertain(family) = phea_engineering::family::family(&setup, &source)? else { panic!("a box") };
/// let gains: Vec<f64> = family.members().iter().map(|values| values[0].round()).collect();
/// assert_eq!(gains, [2.0, 1.0, 4.0]); // the nominal plant first, then what else is on the grid
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn family(setup: &Setup<'_>, source: &dyn Source) -> Result<Family, ProjectFamilyError> {
    let project = setup.project;
    let family = match &project.family {
        Some(declared) if !declared.measured.is_empty() => {
            Family::Measured(measured::family(project, declared, source)?)
        }
        _ => {
            let lumped = uncertain::family(project, uncertain_plant(setup)?)?;
            visited::check(setup, &lumped)?;
            let lumped = null_crossing::with_crossings(setup, lumped)?;
            Family::Uncertain(in_motion::family(setup, &lumped)?.unwrap_or(lumped))
        }
    };
    check_second_path(project, &family)?;
    Ok(family)
}

/// Checks that the plant has a path from load motion if one is limited.
fn check_second_path(project: &Project, family: &Family) -> Result<(), ProjectFamilyError> {
    let wanted = project.specifications.iter().any(|one| one.closed_loop() == Some(ClosedLoop::LoadMotion));
    match family {
        Family::Measured(family) if wanted => {
            let without = family.plants().iter().find(|plant| plant.disturbance.is_none());
            without.map_or(Ok(()), |plant| Err(ProjectFamilyError::LoadMotion(plant.name.clone())))
        }
        _ => Ok(()),
    }
}

/// Plant over the box of its uncertain parameters.
fn uncertain_plant(setup: &Setup<'_>) -> Result<UncertainPlant, ProjectFamilyError> {
    let project = setup.project;
    let parameters = null_sides::parameters(setup)?;
    let is_outside = |one: &&UncertainParameter| {
        let set = project.linear.get(&one.name);
        set.is_some_and(|value| value < one.minimum || value > one.maximum)
    };
    if let Some(UncertainParameter { name, nominal, minimum, maximum }) = parameters.iter().find(is_outside) {
        let (value, minimum, maximum) = (*nominal, *minimum, *maximum);
        return Err(ProjectFamilyError::Linear { name: name.clone(), value, minimum, maximum });
    }
    match &project.plant {
        Some(plant) => formula::uncertain_plant(plant, parameters),
        None => hydraulic::uncertain_plant(setup, parameters),
    }
}
