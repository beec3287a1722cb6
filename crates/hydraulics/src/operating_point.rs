//! Equilibrium of valve and cylinder: chamber pressures at which the flows balance, for any edges
//! and areas.
//!
//! At standstill no flow enters either chamber, in steady motion the piston takes it:
//!
//! ```text
//! q_A(U, p_A) = A_A v        q_B(U, p_B) = -A_B v        F = A_A p_A - A_B p_B
//! ```
//!
//! The flow from chamber to chamber ([`CrossFlow`](crate::cross_port::CrossFlow)) is taken from A
//! and given to B. q_A falls strictly with p_A and q_B with p_B, so each pressure is unique. At
//! standstill p_A rises and p_B falls with U, and in motion both move so that F falls with v: every
//! unknown is found by bisection, to the last bit. The balance over any scalar, including recorded
//! expressions, is [`Balance::settle`].

mod balance;
mod bisection;
mod settling;
mod supply;

use phea_dynamics::scalar::Scalar;

pub use balance::Balance;
pub use settling::{Settled, Steady};
pub use supply::SettledSupply;

use crate::actuator::Actuator;
use crate::fluid::ATMOSPHERIC_PRESSURE_ABSOLUTE;

/// Given values of an operating point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Condition {
    /// Standstill at this spool command in V; zero for the null valve.
    Command(f64),
    /// Standstill under this load; the command that holds it is found.
    Load(SteadyLoad),
    /// Steady motion at this command in V under this load; the velocity is found.
    Motion(f64, SteadyLoad),
    /// Steady motion at this velocity in m/s under this load; the command that holds it is found.
    Moving(f64, SteadyLoad),
    /// This command in V and load pressure in Pa with half the drop over either edge of each path,
    /// as thesis (4.18) assumes: p_A, p_B = (p_S + p_T +- p_L)/2. Steady only for equal edges and
    /// areas; see the net flows.
    Matched(f64, f64),
}

/// Load held by the pressures, without friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SteadyLoad<S = f64> {
    /// Force A_A p_A - A_B p_B, N.
    Force(S),
    /// Load pressure p_A - p_B, Pa.
    Pressure(S),
}

/// Operating point. Units: m, V, Pa, m/s, N, m3/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OperatingPoint<S = f64> {
    /// Piston position x, m.
    pub position: S,
    /// Spool position U_Csp, equal to the command, V.
    pub command: S,
    /// Chamber pressure p_A, Pa.
    pub pressure_a: S,
    /// Chamber pressure p_B, Pa.
    pub pressure_b: S,
    /// Piston velocity, m/s.
    pub velocity: S,
    /// Force of the pressures on the piston, A_A p_A - A_B p_B, N.
    pub hydraulic_force: S,
    /// Surplus flow into chamber A: zero except for [`Condition::Matched`], m3/s.
    pub net_flow_a: S,
    /// Surplus flow into chamber B: zero except for [`Condition::Matched`], m3/s.
    pub net_flow_b: S,
}

/// Error for an operating point that does not exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum OperatingPointError {
    /// A position outside the stroke.
    #[error("position {position} is outside the stroke of {stroke} (m, or rad of a motor)")]
    PositionOutsideStroke {
        /// Requested position, m.
        position: f64,
        /// Stroke, m.
        stroke: f64,
    },
    /// A command beyond the valve's nominal voltage.
    #[error("command {command} V is beyond the nominal {nominal} V")]
    CommandBeyondNominal {
        /// Requested command, V.
        command: f64,
        /// Nominal voltage of the valve, V.
        nominal: f64,
    },
    /// A load (force in N, or load pressure in Pa) that no command within the nominal voltage
    /// holds.
    #[error(
        "a load {} of {} {unit} cannot be held{}: the valve holds {} to {} {unit}",
        if *is_force { "force" } else { "pressure" },
        whole(*load),
        if *moves { " at this velocity" } else { "" },
        whole(*minimum),
        whole(*maximum),
        unit = if *is_force { "N" } else { "Pa" }
    )]
    LoadOutOfReach {
        /// Requested load.
        load: f64,
        /// True for a force in N, false for a load pressure in Pa.
        is_force: bool,
        /// True if the piston moves.
        moves: bool,
        /// Least load that can be held.
        minimum: f64,
        /// Greatest load that can be held.
        maximum: f64,
    },
    /// A chamber pressure below vacuum.
    #[error("a chamber would be at {pressure} Pa gauge, below vacuum")]
    BelowVacuum {
        /// Lower of both chamber pressures, Pa gauge.
        pressure: f64,
    },
    /// A requested value that is NaN, or a balance that was not found.
    #[error("no balance was found")]
    NotFound,
}

/// Load for a message, rounded: whole newtons or pascals are sufficient.
fn whole(value: f64) -> f64 {
    value.round()
}

impl OperatingPoint {
    /// Load pressure, Pa.
    ///
    /// ```text
    /// p_L = p_A - p_B
    /// ```
    pub fn load_pressure(&self) -> f64 {
        self.pressure_a - self.pressure_b
    }
}

/// Operating point of an actuator at piston position `position` in m.
///
/// # Errors
/// Position outside the stroke, a command beyond the nominal voltage, a load out of reach, a
/// pressure below vacuum.
///
/// # Example
/// With unequal edges at null the pressures differ from half the supply pressure, and push the
/// piston:
/// ```
/// # use phea_hydraulics::{actuator::Actuator, line::Line, reference_rig::components};
/// # use phea_hydraulics::{operating_point::*, stiffness::StiffnessModel};
/// # let line = Line::Volume { volume: 1.9e-4, effective_bulk_modulus: 2.6e8 };
/// # let actuator = Actuator::new(components(line, StiffnessModel::Uniform))?;
/// let null = operating_point(&actuator, 0.25, Condition::Command(0.0))?;
/// assert!((null.pressure_a - 37.3e5).abs() < 0.05e5 && (null.pressure_b - 24.0e5).abs() < 0.05e5);
/// let idle = operating_point(&actuator, 0.25, Condition::Load(SteadyLoad::Force(0.0)))?;
/// assert!(idle.command < 0.0 && idle.hydraulic_force.abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn operating_point(
    actuator: &Actuator,
    position: f64,
    condition: Condition,
) -> Result<OperatingPoint, OperatingPointError> {
    let balance = Balance::at(actuator.components(), position);
    let stroke = actuator.components().cylinder.stroke;
    if !stroke.contains(position) {
        let stroke = stroke.length().unwrap_or(f64::INFINITY);
        return Err(OperatingPointError::PositionOutsideStroke { position, stroke });
    }
    if let Condition::Command(command) | Condition::Motion(command, _) | Condition::Matched(command, _) =
        condition
    {
        let nominal = balance.valve.nominal_voltage;
        if command.is_nan() || command.abs() > nominal {
            return Err(OperatingPointError::CommandBeyondNominal { command, nominal });
        }
    }
    let (command, [pressure_a, pressure_b], velocity) = match condition {
        Condition::Command(command) => (command, balance.pressures(command, 0.0)?, 0.0),
        Condition::Load(load) => {
            let command = balance.holding_command(load, 0.0)?;
            (command, balance.pressures(command, 0.0)?, 0.0)
        }
        Condition::Moving(velocity, load) => {
            let command = balance.holding_command(load, velocity)?;
            (command, balance.pressures(command, velocity)?, velocity)
        }
        Condition::Motion(command, load) => {
            let velocity = balance.velocity(command, load)?;
            (command, balance.pressures(command, velocity)?, velocity)
        }
        Condition::Matched(command, load_pressure) => {
            let settled = balance.settle(Steady::Matched(command, load_pressure));
            (command, settled.pressures, 0.0)
        }
    };
    let point = balance.point(position, command, [pressure_a, pressure_b], velocity);
    let lowest = pressure_a.min(pressure_b);
    match lowest > -ATMOSPHERIC_PRESSURE_ABSOLUTE {
        true => Ok(point),
        false => Err(OperatingPointError::BelowVacuum { pressure: lowest }),
    }
}

impl From<Steady> for Condition {
    fn from(steady: Steady) -> Condition {
        match steady {
            Steady::Command(command) => Condition::Command(command),
            Steady::Moving { velocity: 0.0, load } => Condition::Load(load),
            Steady::Moving { velocity, load } => Condition::Moving(velocity, load),
            Steady::Matched(command, load_pressure) => Condition::Matched(command, load_pressure),
        }
    }
}

/// Force of the chamber pressures on the piston, A_A p_A - A_B p_B, N, positive towards B: thesis
/// (4.29).
#[inline(always)]
pub fn hydraulic_force<S: Scalar>([area_a, area_b]: [S; 2], [pressure_a, pressure_b]: [S; 2]) -> S {
    area_a * pressure_a - area_b * pressure_b
}
