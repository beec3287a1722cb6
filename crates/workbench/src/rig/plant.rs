//! The linear plant of a rig: at its operating point, with its load and its leakage, and with what the project states of it.

use phea_dynamics::scalar::Scalar;
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::friction::Friction;
use phea_hydraulics::machine::{Machine, MachineOptions};
use phea_hydraulics::operating_point::{Condition, OperatingPoint};
use phea_hydraulics::plant::{LinearLoad, Plant};
use phea_hydraulics::two_pressure::{TwoPressureLinearParameters, reduce};

use super::parameters::{ParameterOrigin, ResolvedParameter, parameter_field};
use crate::project;

/// Parameters of the linear model that speak of one load pressure.
const OF_LOAD_PRESSURE: [&str; 4] =
    ["piston_area", "flow_gain", "flow_pressure_coefficient", "hydraulic_stiffness"];
/// Chambers whose numbers differ by less, relative to them, are equal.
const EQUAL: f64 = 1e-9;

/// What the load is to the plant, before it is given a value. Units: kg, N s/m, N/m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct YieldingLoad<S = f64> {
    pub(crate) mass: S,
    pub(crate) damping: S,
    /// `None` where the load touches no wall.
    pub(crate) stiffness: Option<S>,
    /// What the touch of a wall damps.
    pub(crate) contact_damping: S,
}

impl<S: Scalar> YieldingLoad<S> {
    pub(crate) fn linear(&self) -> LinearLoad<S> {
        LinearLoad::Yielding {
            mass: self.mass,
            damping: self.damping + self.contact_damping,
            stiffness: self.stiffness.unwrap_or(S::from(0.0)),
        }
    }
}

impl YieldingLoad {
    pub(crate) fn map<S: Scalar>(&self) -> YieldingLoad<S> {
        YieldingLoad {
            mass: S::from(self.mass),
            damping: S::from(self.damping),
            stiffness: self.stiffness.map(S::from),
            contact_damping: S::from(self.contact_damping),
        }
    }
}

/// The load at a force on it in N; `None` where its motion is prescribed. A wall is touched where the force presses on it, or where
/// there is no gap. Hunt and Crossley's damping K c d of a wall pressed by d = F/K is c F.
pub(super) fn yielding_load(declared: &project::Load, force: f64) -> Option<YieldingLoad> {
    let damping = declared.damping.unwrap_or(0.0);
    let mass = declared.mass?;
    match declared.model {
        project::LoadModel::Prescribed => None,
        project::LoadModel::SpringMassDamper => {
            Some(YieldingLoad { mass, damping, stiffness: declared.stiffness, contact_damping: 0.0 })
        }
        project::LoadModel::Wall => {
            let touched = force > 0.0 || declared.gap.unwrap_or(0.0) == 0.0;
            let contact_damping = declared.relative_damping * force.max(0.0);
            let stiffness = declared.stiffness.filter(|_| touched);
            Some(YieldingLoad { mass, damping, stiffness, contact_damping })
        }
    }
}

/// The operating point with leakage across the piston: the pressures at which all flows balance, under the same command or load.
/// One without balance, as [`Condition::Matched`] states it, stays as it is.
pub(super) fn with_leakage(
    point: OperatingPoint,
    actuator: &Actuator,
    condition: Condition,
    leakage: Option<f64>,
) -> OperatingPoint {
    let balanced = || -> Option<OperatingPoint> {
        // Nothing but valve and piston decides the balance.
        let components =
            Components { friction: Friction::Viscous { viscous: 0.0 }, ..*actuator.components() };
        let options = MachineOptions { internal_leakage: leakage, ..MachineOptions::default() };
        let machine = Machine::new(&Actuator::new(components).ok()?, &options).ok()?;
        let rest = match condition {
            Condition::Matched(..) => return None,
            Condition::Command(_) => machine.rest(&point),
            Condition::Load(_) | Condition::Motion(..) => machine.rest_under_load(&point),
        };
        let state = rest.ok()?.state;
        let &[command, _, pressure_a, pressure_b, deflection, velocity] = state.first_chunk()?;
        let hydraulic_force = deflection * components.force_sensor.stiffness;
        Some(OperatingPoint { command, pressure_a, pressure_b, hydraulic_force, velocity, ..point })
    };
    if leakage.is_some() { balanced().unwrap_or(point) } else { point }
}

/// Whether one load pressure tells all of the plant: where the project states a parameter that speaks of one, or where both chambers
/// are equal and stay so over what is uncertain.
pub(crate) fn has_one_pressure(
    parameters: &[ResolvedParameter],
    chambers: &TwoPressureLinearParameters,
    uncertain: &[String],
) -> bool {
    let speaks = |name: &str| OF_LOAD_PRESSURE.contains(&name);
    let stated = |one: &ResolvedParameter| one.origin != ParameterOrigin::Derived && speaks(one.name);
    let of_one_side =
        |name: &str| ["line.a.", "line.b.", "operating_point."].iter().any(|side| name.starts_with(side));
    let equal = |[a, b]: [f64; 2]| (a - b).abs() <= EQUAL * a.abs();
    let pressures = [chambers.chambers.flow_pressure_a, chambers.chambers.flow_pressure_b];
    parameters.iter().any(stated)
        || uncertain.iter().any(|name| speaks(name))
        || ([chambers.areas, chambers.compliances, pressures].into_iter().all(equal)
            && !uncertain.iter().any(|name| of_one_side(name) || name == "cylinder.stroke"))
}

/// The plant of these chambers, each stated parameter of the linear model in its place, in their order.
pub(crate) fn plant<'n, S: Scalar>(
    chambers: &TwoPressureLinearParameters<S>,
    stated: impl Iterator<Item = (&'n str, S)>,
    one_pressure: bool,
    leakage: S,
    load: LinearLoad<S>,
) -> Plant<S> {
    let mut linear = reduce(chambers);
    for (name, value) in stated {
        if let Some(slot) = parameter_field(&mut linear, name) {
            *slot = value;
        }
    }
    if one_pressure {
        return Plant::of_load_pressure(&linear, leakage, load);
    }
    let stated = TwoPressureLinearParameters {
        moving_mass: linear.moving_mass,
        viscous_friction: linear.viscous_friction,
        sensor_stiffness: linear.sensor_stiffness,
        valve_natural_frequency: linear.valve_natural_frequency,
        valve_damping_ratio: linear.valve_damping_ratio,
        ..*chambers
    };
    Plant::of_two_pressures(&stated, leakage, load)
}

/// What the project states of the linear model: name and value.
pub(crate) fn stated(parameters: &[ResolvedParameter]) -> impl Iterator<Item = (&'static str, f64)> {
    let stated = parameters.iter().filter(|one| one.origin != ParameterOrigin::Derived);
    stated.map(|one| (one.name, one.value))
}
