//! From the declaration to the values for computing: the actuator as physics, its operating point,
//! and every parameter of the linear model with its origin.

mod accumulator;
mod assembly;
mod at_point;
mod cross_port;
mod declared;
mod ideal_valve;
mod in_loop;
mod largest_flow;
mod lines;
mod load;
mod of_motion;
mod outside;
mod parameters;
mod place;
mod plant;
mod series;
mod supply;

use num_complex::Complex64;
use phea_dynamics::controller::{RateSensor, VirtualImpedance};
use phea_hydraulics::actuator::{Actuator, ActuatorError, Components};
use phea_hydraulics::force_sensor::in_series;
use phea_hydraulics::line::LineError;
use phea_hydraulics::linear::LinearParameters;
use phea_hydraulics::operating_point::{
    Condition, OperatingPoint, OperatingPointError, Settled, SettledSupply, operating_point,
};
use phea_hydraulics::plant::{LinearLoad, LinearPlant, PlantInMotion};
use phea_hydraulics::servovalve::SpoolDirection;
use phea_hydraulics::two_pressure::{TwoPressureLinearParameters, TwoPressureModel};

use crate::project::{self, Project};
use crate::quantity::MotionKind;

pub(crate) use accumulator::accumulator_place;
pub use accumulator::{ChargedRange, EmptyAccumulator, charged_range};
pub use assembly::{actuator, components};
pub(crate) use at_point::{RigAtPoint, UnsolvedRig};
pub use cross_port::{CrossPortAtPoint, cross_port_at_point};
pub use declared::DeclaredRig;
pub(crate) use ideal_valve::stand_in_coefficient;
pub use ideal_valve::{is_ideal, reduced, two_pressures};
pub use in_loop::{FeedForwardPath, PressureFeedbackPath};
pub(crate) use in_loop::{inner_feedback, limits_load_motion, pressure_ratio, with_controller_of};
pub use largest_flow::{FlowLimit, LargestFlow, largest_flow};
pub(crate) use lines::{quarter_wave, quarter_wave_of};
pub use load::rod_end;
pub use of_motion::OfMotion;
pub use outside::OutsideParameter;
pub(crate) use outside::outside;
pub(crate) use parameters::stated;
pub use parameters::{ParameterOrigin, ResolvedParameter};
pub use place::place;
pub(crate) use plant::{Equal, are_equal, sides, states_one_pressure};
pub use series::{series_coil, stall_force, waves_right_to};
pub(crate) use supply::power_at_rest;
pub use supply::settled_supply;

/// A rig with everything that procedures compute with.
#[derive(Clone, Debug, PartialEq)]
pub struct Rig {
    /// How it moves: of a rig that turns, every position is in rad and every force in N m.
    pub motion: MotionKind,
    /// The actuator as physics.
    pub actuator: Actuator,
    /// The point about which the linear models are taken.
    pub point: OperatingPoint,
    /// The settled state of a limited supply at that point; `None` for one with a constant
    /// pressure.
    pub supply: Option<SettledSupply>,
    /// What is known about that point.
    pub condition: Condition,
    /// The nonlinear two-pressure model, nominal stiffening.
    pub model: TwoPressureModel,
    /// Its linearisation at the operating point.
    pub two_pressure: TwoPressureLinearParameters,
    /// Parameters of the fifth-order model as they follow from the rig.
    pub derived: LinearParameters,
    /// The same in use: the value of `[linear]` takes precedence over the nominal one of
    /// `[uncertainty]`, and this over the derived value.
    pub parameters: Vec<ResolvedParameter>,
    /// The values that hold.
    pub linear: LinearParameters,
    /// Conductance from chamber to chamber at the operating point in m3/(s Pa): leakage across the
    /// piston, and a valve between the chambers that no capacity closes.
    pub internal_leakage: f64,
    /// The linear plant of every verdict: nominal, at the operating point, with lumped lines.
    pub plant: LinearPlant,
    /// The same with its lines in motion, which is then the plant of every verdict; `None` where
    /// both are lumped.
    pub in_motion: Option<PlantInMotion>,
    /// The feed-forward of the load velocity in the linear loop, which [`Rig::in_loop`] includes.
    pub fed: Option<FeedForwardPath>,
    /// The feedback of the chambers' pressures, which [`Rig::in_loop`] includes where it is not
    /// sampled.
    pub fed_back: Option<PressureFeedbackPath>,
    /// The virtual impedance of the loop, which [`Rig::in_loop`] includes.
    pub virtual_impedance: Option<VirtualImpedance>,
}

/// Reason why a project has no rig.
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
    OperatingPoint(OfMotion<OperatingPointError>),
    /// A line that its model cannot describe.
    #[error("[line] model: {0}")]
    Line(#[from] LineError),
    /// An accumulator whose gas is shut off at the operating point.
    #[error(transparent)]
    Accumulator(#[from] EmptyAccumulator),
}

impl Rig {
    /// F_e/U_C in N/V at a frequency in rad/s: of the plant of every verdict.
    pub fn response(&self, frequency_rad_per_s: f64) -> Complex64 {
        match &self.in_motion {
            Some(plant) => plant.response(Complex64::new(0.0, frequency_rad_per_s))[0],
            None => self.plant.coefficients().command.at_frequency(frequency_rad_per_s),
        }
    }

    /// The linear parameters in use, with what leaks from chamber to chamber in parallel to K_c:
    /// with one load pressure both have the same effect; and with the stiffness of a series element
    /// in series with the force sensor.
    pub fn leaking(&self) -> LinearParameters {
        let flow_pressure_coefficient = self.linear.flow_pressure_coefficient + self.internal_leakage;
        self.softened(&LinearParameters { flow_pressure_coefficient, ..self.linear })
    }

    /// [`Rig::leaking`] with the stiffness of the load in series with the force sensor as well: the
    /// first-order model against the load. Of a load that no stiffness holds, those with the load
    /// held still.
    pub fn against_load(&self) -> LinearParameters {
        self.before_load(&self.leaking())
    }

    /// These parameters with the stiffness of the load in series with that beyond the piston.
    pub(crate) fn before_load(&self, parameters: &LinearParameters) -> LinearParameters {
        let sensor_stiffness = match self.load_stiffness() {
            Some(load) => in_series(parameters.sensor_stiffness, load),
            None => parameters.sensor_stiffness,
        };
        LinearParameters { sensor_stiffness, ..*parameters }
    }

    /// True if the load can move under force.
    pub fn load_moves(&self) -> bool {
        self.plant.load != LinearLoad::Prescribed
    }

    /// Stiffness of the load at the operating point in N/m at the rod; `None` where the motion of
    /// the load is prescribed, or no stiffness holds it.
    pub fn load_stiffness(&self) -> Option<f64> {
        self.plant.load.stiffness_at_rest()
    }

    /// These parameters with the stiffness of a series element in series with the force sensor: the
    /// whole of the effect of a spring that has neither damper nor mass.
    pub fn softened(&self, parameters: &LinearParameters) -> LinearParameters {
        LinearParameters { sensor_stiffness: self.beyond_piston(parameters.sensor_stiffness), ..*parameters }
    }

    /// The linearised two-pressure model with what leaks from chamber to chamber, with the
    /// stiffness of a series element in series with the force sensor, and with the load held still.
    pub(crate) fn two_pressure_held(&self) -> LinearPlant {
        let sensor_stiffness = self.beyond_piston(self.two_pressure.sensor_stiffness);
        let parameters = TwoPressureLinearParameters { sensor_stiffness, ..self.two_pressure };
        let held = LinearPlant::of_two_pressures(&parameters, self.internal_leakage, LinearLoad::Prescribed);
        LinearPlant { area_stiffness: self.plant.area_stiffness, ..held }
    }

    /// The derived parameters, as [`Rig::leaking`] has those in use.
    pub(crate) fn leaking_derived(&self) -> LinearParameters {
        let flow_pressure_coefficient = self.derived.flow_pressure_coefficient + self.internal_leakage;
        self.softened(&LinearParameters { flow_pressure_coefficient, ..self.derived })
    }

    /// The model with one load pressure and these parameters against the load, with what is in
    /// series with the force sensor.
    pub(crate) fn one_pressure(&self, parameters: &LinearParameters) -> LinearPlant {
        let plant = LinearPlant::of_load_pressure(parameters, self.internal_leakage, self.plant.load);
        LinearPlant { series: self.plant.series, ..plant }
    }

    /// K_qU in m3/(s V) of a spool at null that retracts the piston and of one that extends it;
    /// `None` where they are equal, or the spool is not at null.
    pub fn null_flow_gains(&self) -> Option<[f64; 2]> {
        let gains = [SpoolDirection::Retracting, SpoolDirection::Extending].map(|side| self.flow_gain(side));
        (!are_equal([gains])).then_some(gains)
    }

    /// K_qU that follows from the rig, with the slopes of one side of a spool at null.
    pub fn flow_gain(&self, side: SpoolDirection) -> f64 {
        reduced(&two_pressures(&self.model, &self.point, side)).flow_gain
    }

    /// The stiffness in N/m of a force sensor together with a series element, where there is one.
    fn beyond_piston(&self, sensor_stiffness: f64) -> f64 {
        self.plant.series.map_or(sensor_stiffness, |series| in_series(sensor_stiffness, series.stiffness()))
    }

    /// Assembles the rig of a project and linearises it: [`Setup`](crate::setup::Setup) holds it.
    ///
    /// # Errors
    /// [`RigError`] if a parameter is impossible, or there is no equilibrium at the operating
    /// point.
    pub fn of(
        project: &Project,
        declared: &project::DeclaredActuator,
        rate_sensor: RateSensor,
        virtual_impedance: Option<VirtualImpedance>,
    ) -> Result<Rig, RigError> {
        let actuator = assembly::actuator(declared)?;
        let components = actuator.components();
        let plain = DeclaredRig::plain(project, declared);
        let unsolved = UnsolvedRig::of(&plain);
        // a pump that settles nowhere leaves its error to the point at the stated pressure
        let supply = unsolved.settled_supply().filter(|found| found.supply.pressure.is_finite());
        // the valve at the pressure of the pump, lines and stall forces at the stated one
        let settled = supply.map_or(components.supply, |found| found.supply);
        let at_valve = Actuator::new(Components { supply: settled, ..*components })?;
        let (position, condition) = (unsolved.position, Condition::from(unsolved.steady));
        let unbalanced = |error| RigError::OperatingPoint(OfMotion { motion: project.motion(), error });
        let point = operating_point(&at_valve, position, condition).map_err(unbalanced)?;
        accumulator::charged(declared, &components.gas, &point)?;
        let pressures = [point.pressure_a, point.pressure_b];
        let supply = supply
            .map(|found| SettledSupply { settled: Settled { command: point.command, pressures }, ..found });
        let at = RigAtPoint::of(&plain, &unsolved, settled, point, stated(project));
        // steps that choose, for numbers only: no small motions of a supply that settles nowhere,
        // the edges of the valve as it leaks, then the limit of an ideal one, which passes no flow
        let at = RigAtPoint { supply: at.supply.filter(|_| supply.is_some()), ..at };
        let edges = at.supply.is_none_or(|supply| are_equal([supply.edges]));
        let at = at.in_the_limit(stated(project));
        let derived = reduced(&at.chambers);
        let parameters = parameters::resolve(project, &derived);
        let alike = [are_equal(sides(&at.chambers)), edges];
        let plant = at.plant(Equal::new(declared, alike, states_one_pressure(&parameters, &[])));
        let in_motion = at.in_motion(&plant)?;
        Ok(Rig {
            motion: declared.motion(),
            actuator,
            point,
            supply,
            condition,
            model: at.model,
            two_pressure: at.chambers,
            derived,
            parameters,
            linear: at.linear,
            internal_leakage: at.leakage,
            plant,
            in_motion,
            fed: FeedForwardPath::of(project, &at.linear, rate_sensor),
            fed_back: PressureFeedbackPath::of(project, components),
            virtual_impedance,
        })
    }
}
