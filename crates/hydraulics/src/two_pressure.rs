//! Two-pressure model: one pressure per chamber, the spool, the piston on the force sensor. The
//! reference for the reduced linear models, at any position, with any edges and any areas.
//!
//! ```text
//! d2U_Csp/dt2 = w_nv^2 (U_C - U_Csp) - 2 xi_v w_nv dU_Csp/dt                    thesis (4.1)
//! C_A(x) dp_A/dt = q_A(U_Csp, p_A) - A_A v                                      thesis (4.25)
//! C_B(x) dp_B/dt = q_B(U_Csp, p_B) + A_B v                                      thesis (4.26), corrected
//! d(x - x_L)/dt = v - v_L
//! M dv/dt = A_A p_A - A_B p_B - f_v v - F_e,      F_e = K_S (x - x_L)           thesis (4.29)
//! ```
//!
//! The deflection of the sensor is a state and the piston's position is not: the force is a small
//! difference of two long positions, which would lose six digits.

mod linearization;
mod reduction;

pub use linearization::{
    TwoPressureLinearParameters, linearize, two_pressure_coefficients, two_pressure_linear_parameters,
};
pub use reduction::{Reduction, reduce, reduction};

use phea_dynamics::scalar::Scalar;

use crate::actuator::{Actuator, Components};
use crate::force_sensor;
use crate::line::StiffeningMember;
use crate::operating_point::{OperatingPoint, hydraulic_force};
use crate::outward_flow::OutwardFlow;
use crate::servovalve::{ChamberFlows, Servovalve, Supply, chamber_flows};
use crate::stiffness::{ChamberCompliance, compliance_at};

/// Parameters of the equations. Units: kg, N s/m, N/m and those of the components.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoPressureModel<S = f64> {
    /// The servovalve.
    pub valve: Servovalve<S>,
    /// Supply and tank pressures.
    pub supply: Supply<S>,
    /// Compliance of both chambers with their lines.
    pub chambers: ChamberCompliance<S>,
    /// Moving mass M, kg.
    pub moving_mass: S,
    /// Viscous friction f_v, N s/m.
    pub viscous_friction: S,
    /// Sensor stiffness K_S, N/m.
    pub sensor_stiffness: S,
    /// Flow from each chamber to the tank; `None` without such flow.
    pub outward: Option<OutwardFlow<S>>,
}

/// States of the model. Units: V, V/s, Pa, m, m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoPressureState<S = f64> {
    /// Spool position U_Csp, V.
    pub spool: S,
    /// Rate of the spool position, V/s.
    pub spool_rate: S,
    /// Chamber pressure p_A, Pa.
    pub pressure_a: S,
    /// Chamber pressure p_B, Pa.
    pub pressure_b: S,
    /// Deflection of the force sensor x - x_L, m.
    pub deflection: S,
    /// Piston velocity v, m/s.
    pub velocity: S,
}

/// Inputs of the model. Units: V, m/s, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoPressureInput<S = f64> {
    /// Command U_C, V.
    pub command: S,
    /// Load velocity v_L, m/s.
    pub load_velocity: S,
    /// Load position x_L, m; its rate is the load velocity.
    pub load_position: S,
}

impl<S: Copy> TwoPressureState<S> {
    /// States in the order of the fields.
    pub fn to_array(&self) -> [S; 6] {
        [self.spool, self.spool_rate, self.pressure_a, self.pressure_b, self.deflection, self.velocity]
    }

    /// State from numbers in the order of the fields.
    pub fn from_array([spool, spool_rate, pressure_a, pressure_b, deflection, velocity]: [S; 6]) -> Self {
        TwoPressureState { spool, spool_rate, pressure_a, pressure_b, deflection, velocity }
    }
}

phea_dynamics::parameters! {
    TwoPressureModel {
        valve, supply, chambers, moving_mass, viscous_friction, sensor_stiffness, outward,
    }
}

impl<S: Scalar> TwoPressureModel<S> {
    /// Model as in [`TwoPressureModel::new`], from components over any scalar.
    pub fn of(
        components: &Components<S>,
        pressures: [S; 2],
        member: StiffeningMember,
        viscous_friction: S,
    ) -> TwoPressureModel<S> {
        TwoPressureModel {
            valve: components.valve,
            supply: components.supply,
            chambers: components.chamber_compliance(pressures, member),
            moving_mass: components.cylinder.moving_mass,
            viscous_friction,
            sensor_stiffness: components.force_sensor.stiffness,
            outward: components.outward.if_present(),
        }
    }

    /// Slopes of the flows from both chambers to the tank over their pressures in Pa, m3/(s Pa);
    /// `None` without such flow.
    pub fn outward_slopes(&self, pressures: [S; 2]) -> Option<[S; 2]> {
        Some(self.outward?.slopes(pressures, self.supply.tank_pressure))
    }
}

impl TwoPressureModel {
    /// Model of an actuator, its friction replaced by a viscous one in N s/m, the fluid's modulus
    /// taken at these chamber pressures in Pa (relevant only with entrained air).
    pub fn new(
        actuator: &Actuator,
        pressures: [f64; 2],
        member: StiffeningMember,
        viscous_friction: f64,
    ) -> TwoPressureModel {
        TwoPressureModel::of(actuator.components(), pressures, member, viscous_friction)
    }

    /// State and input in which the model rests (or moves steadily with its load) at an operating
    /// point.
    pub fn at(&self, point: &OperatingPoint) -> (TwoPressureState, TwoPressureInput) {
        let force = point.hydraulic_force - self.viscous_friction * point.velocity;
        let deflection = force / self.sensor_stiffness;
        let state = TwoPressureState {
            spool: point.command,
            spool_rate: 0.0,
            pressure_a: point.pressure_a,
            pressure_b: point.pressure_b,
            deflection,
            velocity: point.velocity,
        };
        let load_position = point.position - deflection;
        let input = TwoPressureInput { command: point.command, load_velocity: point.velocity, load_position };
        (state, input)
    }
}

/// Rates of all states, per second: the equations of this module's documentation.
///
/// # Example
/// At an operating point the model is at rest: the remaining rates are rounding:
/// ```
/// use phea_hydraulics::actuator::Actuator;
/// use phea_hydraulics::line::StiffeningMember;
/// use phea_hydraulics::operating_point::{Condition, SteadyLoad, operating_point};
/// use phea_hydraulics::reference_rig::{components, hose_line};
/// use phea_hydraulics::stiffness::StiffnessModel;
/// use phea_hydraulics::two_pressure::{TwoPressureModel, rates};
/// let actuator = Actuator::new(components(hose_line(), StiffnessModel::ByVolume))?;
/// let point = operating_point(&actuator, 0.2, Condition::Load(SteadyLoad::Force(3e3)))?;
/// let pressures = [point.pressure_a, point.pressure_b];
/// let model = TwoPressureModel::new(&actuator, pressures, StiffeningMember::Nominal, 100.0);
/// let (state, input) = model.at(&point);
/// let rest = rates(&model, &state, &input);
/// assert!(rest.velocity.abs() < 1e-6 && rest.pressure_a.abs() < 10.0 && rest.pressure_b.abs() < 10.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn rates<S: Scalar>(
    model: &TwoPressureModel<S>,
    state: &TwoPressureState<S>,
    input: &TwoPressureInput<S>,
) -> TwoPressureState<S> {
    let TwoPressureState { spool, spool_rate, pressure_a, pressure_b, deflection, velocity } = *state;
    let chambers = &model.chambers;
    let position = input.load_position + deflection;
    let [compliance_a, compliance_b] = compliance_at(chambers, position);
    let ChamberFlows { into_a, into_b } =
        chamber_flows(&model.valve, &model.supply, spool, pressure_a, pressure_b);
    let outward = model.outward.map(|out| out.flows([pressure_a, pressure_b], model.supply.tank_pressure));
    let [out_of_a, out_of_b] = outward.unwrap_or([S::from(0.0); 2]);
    let natural_frequency = model.valve.natural_frequency;
    let [area_a, area_b] = chambers.areas_at(position);
    let pushing = hydraulic_force([area_a, area_b], [pressure_a, pressure_b]);
    let sensed = force_sensor::force(model.sensor_stiffness, deflection);
    TwoPressureState {
        spool: spool_rate,
        spool_rate: natural_frequency.squared() * (input.command - spool)
            - S::from(2.0) * model.valve.damping_ratio * natural_frequency * spool_rate,
        pressure_a: (into_a - out_of_a - area_a * velocity) / compliance_a,
        pressure_b: (into_b - out_of_b + area_b * velocity) / compliance_b,
        deflection: velocity - input.load_velocity,
        velocity: (pushing - model.viscous_friction * velocity - sensed) / model.moving_mass,
    }
}
