//! From what is declared to what is computed with: the actuator as physics, its operating point, and every parameter
//! of the linear model with where it comes from.

mod assembly;
mod lines;
mod parameters;
mod plant;
mod sizing;

use num_complex::Complex64;
use phea_hydraulics::actuator::{Actuator, ActuatorError};
use phea_hydraulics::friction::ViscousSlope;
use phea_hydraulics::line::{LineError, Member};
use phea_hydraulics::linear::LinearParameters;
use phea_hydraulics::machine::Chambers;
use phea_hydraulics::operating_point::{
    Condition, Load, OperatingPoint, OperatingPointError, operating_point,
};
use phea_hydraulics::plant::{BehindLines, LinearLoad, Plant, PlantInMotion};
use phea_hydraulics::servovalve::Direction;
use phea_hydraulics::two_pressure::{
    TwoPressureLinearParameters, TwoPressureModel, reduce, two_pressure_linear_parameters,
};

use crate::project::{self, Project};

pub(crate) use assembly::actuator;
pub(crate) use lines::lines;
pub use parameters::{ParameterOrigin, ResolvedParameter};
pub(crate) use plant::{YieldingLoad, has_one_pressure, plant, stated};
pub use sizing::{SizingError, sizing_problem};

/// A rig ready to be computed with.
#[derive(Clone, Debug, PartialEq)]
pub struct Rig {
    /// The actuator as physics.
    pub actuator: Actuator,
    /// Where the linear models are taken.
    pub point: OperatingPoint,
    /// What is known of that point.
    pub condition: Condition,
    /// The nonlinear two-pressure model, nominal stiffening.
    pub model: TwoPressureModel,
    /// Its linearisation at the operating point.
    pub two_pressure: TwoPressureLinearParameters,
    /// Parameters of the fifth-order model as they follow from the rig.
    pub derived: LinearParameters,
    /// The same with what the project sets: `[linear]` before the nominal of `[uncertainty]` before the derived value.
    pub parameters: Vec<ResolvedParameter>,
    /// The values that hold.
    pub linear: LinearParameters,
    /// Leakage across the piston in m3/(s Pa).
    pub internal_leakage: f64,
    /// What the force sensor pushes on, where it yields.
    pub(crate) load: Option<YieldingLoad>,
    /// The linear plant that every verdict is of: nominal, at the operating point, with lumped lines.
    pub plant: Plant,
    /// The same with its lines in motion, which is then what every verdict is of; `None` where both are lumped.
    pub in_motion: Option<PlantInMotion>,
}

/// Why a project has no rig to compute with.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RigError {
    /// The project describes another plant.
    #[error("the project has a [plant] and no actuator: this command needs [valve], [cylinder] and [line]")]
    NoActuator,
    /// Parameters outside physics.
    #[error(transparent)]
    Actuator(#[from] ActuatorError),
    /// No equilibrium at the declared operating point.
    #[error("[operating_point]: {0}")]
    OperatingPoint(#[from] OperatingPointError),
    /// A line that its model does not fit.
    #[error("[line] model: {0}")]
    Line(#[from] LineError),
    /// The friction has no slope to linearise with.
    #[error("[cylinder.friction] has no viscous part to linearise with")]
    Friction,
}

impl Rig {
    /// F_e/U_C in N/V at a frequency in rad/s: of the plant that every verdict is of.
    pub fn response(&self, frequency_rad_per_s: f64) -> Complex64 {
        match &self.in_motion {
            Some(plant) => plant.response(Complex64::new(0.0, frequency_rad_per_s))[0],
            None => self.plant.coefficients().command.at_frequency(frequency_rad_per_s),
        }
    }

    /// The linear parameters that hold, the leakage across the piston beside K_c: with one load pressure it is the same.
    pub fn leaking(&self) -> LinearParameters {
        let flow_pressure_coefficient = self.linear.flow_pressure_coefficient + self.internal_leakage;
        LinearParameters { flow_pressure_coefficient, ..self.linear }
    }

    /// Assembles the rig of a project and linearises it.
    ///
    /// # Errors
    /// [`RigError`] if the project is about another plant, a parameter is impossible, or nothing balances at the
    /// operating point.
    pub fn new(project: &Project) -> Result<Rig, RigError> {
        let declared = project.actuator.as_ref().ok_or(RigError::NoActuator)?;
        let actuator = assembly::actuator(declared)?;
        let components = actuator.components();
        let condition = condition(&project.operating_point);
        let stroke = components.cylinder.stroke;
        let position = project.operating_point.position.unwrap_or(stroke / 2.0);
        let leakage = declared.cylinder.internal_leakage;
        let point = operating_point(&actuator, position, condition)?;
        let point = plant::with_leakage(point, &actuator, condition, leakage);
        let friction = components.friction.viscous_slope(ViscousSlope::Viscous).ok_or(RigError::Friction)?;
        let pressures = [point.pressure_a, point.pressure_b];
        let model = TwoPressureModel::new(&actuator, pressures, Member::Nominal, friction);
        let two_pressure = two_pressure_linear_parameters(&model, &point, Direction::Mean);
        let derived = reduce(&two_pressure);
        let parameters = parameters::resolve(project, &derived);
        let linear = parameters::linear(&parameters, &derived);
        let internal_leakage = leakage.unwrap_or(0.0);
        let load = plant::yielding_load(&declared.load, point.hydraulic_force);
        let plant = plant(
            &two_pressure,
            stated(&parameters),
            has_one_pressure(&parameters, &two_pressure, &[]),
            internal_leakage,
            load.map_or(LinearLoad::Prescribed, |load| load.linear()),
        );
        let of_rig = [&components.line_a, &components.line_b];
        let lines = lines(&declared.line, of_rig, &components.fluid, actuator.mean_pressure())?;
        let bare = Chambers::behind_lines(&actuator, Member::Nominal, [0.0; 2]);
        let chambers = bare.compliance(position, pressures);
        let lumped = two_pressure.compliances;
        let in_motion =
            lines.map(|lines| PlantInMotion::new(&plant, &BehindLines { lines, chambers, lumped }));
        Ok(Rig {
            actuator,
            point,
            condition,
            model,
            two_pressure,
            derived,
            parameters,
            linear,
            internal_leakage,
            load,
            plant,
            in_motion,
        })
    }
}

/// Null blocks the piston; a command moves it, with no load pressure where none is declared, thesis (4.18).
fn condition(declared: &project::OperatingPoint) -> Condition {
    match (declared.command, declared.load_pressure) {
        (Some(command), Some(load_pressure)) => Condition::Matched(command, load_pressure),
        (Some(command), None) if command != 0.0 => Condition::Matched(command, 0.0),
        (None, Some(load_pressure)) => Condition::Load(Load::Pressure(load_pressure)),
        (Some(_) | None, None) => Condition::Command(0.0),
    }
}
