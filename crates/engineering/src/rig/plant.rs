//! The linear plant of a rig: at its operating point, with its load, its leakage and the parameters
//! that the project states.

use phea_dynamics::scalar::Scalar;
use phea_hydraulics::actuator::Components;
use phea_hydraulics::linear::LinearParameters;
use phea_hydraulics::plant::{ChamberDynamics, LinearLoad, LinearPlant, YieldingSupply};
use phea_hydraulics::servovalve::ChamberCoefficients;
use phea_hydraulics::two_pressure::{TwoPressureLinearParameters, reduce};

use super::parameters::{ParameterOrigin, ResolvedParameter, replaced};
use crate::project::{self, DeclaredAdjustment};

/// Parameters of the linear model that presuppose one load pressure.
const OF_LOAD_PRESSURE: [&str; 4] =
    ["piston_area", "flow_gain", "flow_pressure_coefficient", "hydraulic_stiffness"];
/// Chambers whose numbers differ by less, relative to them, are equal.
const EQUAL: f64 = 1e-9;

/// Whether the project states a parameter of the linear model that presupposes one load pressure;
/// `uncertain` are names of its numbers.
pub(crate) fn states_one_pressure(parameters: &[ResolvedParameter], uncertain: &[String]) -> bool {
    let speaks = |name: &str| OF_LOAD_PRESSURE.contains(&name);
    let stated = |one: &ResolvedParameter| one.origin != ParameterOrigin::Derived && speaks(one.name);
    parameters.iter().any(stated) || uncertain.iter().any(|name| speaks(name))
}

/// Whether numbers of both chambers are equal, so that one load pressure describes them.
pub(crate) fn are_equal(sides: impl IntoIterator<Item = [f64; 2]>) -> bool {
    sides.into_iter().all(|[a, b]| (a - b).abs() <= EQUAL * a.abs())
}

/// Areas, compliances and flow-pressure coefficients of both chambers.
pub fn sides<S: Scalar>(chambers: &TwoPressureLinearParameters<S>) -> [[S; 2]; 3] {
    let ChamberCoefficients { flow_pressure_a, flow_pressure_b, .. } = chambers.chambers;
    [chambers.areas, chambers.compliances, [flow_pressure_a, flow_pressure_b]]
}

/// The parameters of the fifth-order model from these chambers, replaced by the stated ones, in
/// their order.
pub fn linear<'n, S: Scalar>(
    chambers: &TwoPressureLinearParameters<S>,
    stated: impl Iterator<Item = (&'n str, S)>,
) -> LinearParameters<S> {
    replaced(&reduce(chambers), stated)
}

/// The plant of these chambers with the stated parameters.
pub fn plant<S: Scalar>(
    chambers: &TwoPressureLinearParameters<S>,
    linear: &LinearParameters<S>,
    one_pressure: bool,
    leakage: S,
    load: LinearLoad<S>,
) -> LinearPlant<S> {
    if one_pressure {
        return LinearPlant::of_load_pressure(linear, leakage, load);
    }
    let stated = TwoPressureLinearParameters {
        moving_mass: linear.moving_mass,
        viscous_friction: linear.viscous_friction,
        sensor_stiffness: linear.sensor_stiffness,
        valve_natural_frequency: linear.valve_natural_frequency,
        valve_damping_ratio: linear.valve_damping_ratio,
        ..*chambers
    };
    LinearPlant::of_two_pressures(&stated, leakage, load)
}

/// The same plant with a limited supply. Where a stated number changes the valve in the model with
/// one load pressure, the flow from the supply changes in proportion.
pub(crate) fn with_supply<S: Scalar>(
    plant: LinearPlant<S>,
    supply: YieldingSupply<S>,
    chambers: &TwoPressureLinearParameters<S>,
) -> LinearPlant<S> {
    let supply = match plant.chambers {
        ChamberDynamics::TwoPressures { .. } => supply,
        ChamberDynamics::LoadPressure { flow_gain, flow_pressure_coefficient, .. } => {
            let (two, own) = (S::from(2.0), &chambers.chambers);
            let both = two * flow_pressure_coefficient;
            let [edge_a, edge_b] = supply.edges;
            YieldingSupply {
                edges: [edge_a * both / own.flow_pressure_a, edge_b * both / own.flow_pressure_b],
                flow_gain: supply.flow_gain * two * flow_gain / (own.flow_gain_a + own.flow_gain_b),
                ..supply
            }
        }
    };
    LinearPlant { supply: Some(supply), ..plant }
}

/// The same plant with the gas of accumulators that lies behind a neck or a valve or exchanges
/// heat, and with a pressure a chamber. Where a stated number makes these chambers stiffer than
/// their parts are, the gas is stiffened alike.
pub(crate) fn with_gas<S: Scalar>(
    plant: LinearPlant<S>,
    components: &Components<S>,
    chambers: &TwoPressureLinearParameters<S>,
    pressures: [S; 2],
) -> LinearPlant<S> {
    let gas = components.gas_branches(pressures);
    if gas.iter().all(Option::is_none) {
        return plant;
    }
    let alone = without_branches(components, pressures, chambers.compliances);
    match plant.chambers {
        ChamberDynamics::TwoPressures { areas, flow_gains, flow_pressures, .. } => {
            let chambers =
                ChamberDynamics::TwoPressures { areas, compliances: alone, flow_gains, flow_pressures };
            LinearPlant { chambers, gas, ..plant }
        }
        ChamberDynamics::LoadPressure {
            useful_area,
            flow_gain,
            flow_pressure_coefficient,
            hydraulic_stiffness,
        } => {
            let two = S::from(2.0);
            let stated = two * useful_area.squared() / hydraulic_stiffness;
            let [share_a, share_b] = chambers.compliances.map(|own| stated / own);
            let [gas_a, gas_b] = gas;
            let chambers = ChamberDynamics::TwoPressures {
                areas: [useful_area; 2],
                compliances: [alone[0] * share_a, alone[1] * share_b],
                flow_gains: [flow_gain; 2],
                flow_pressures: [two * flow_pressure_coefficient; 2],
            };
            let gas = [gas_a.map(|gas| gas.softened(share_a)), gas_b.map(|gas| gas.softened(share_b))];
            LinearPlant { chambers, gas, ..plant }
        }
    }
}

/// Compliances of both chambers in m3/Pa less that of the gas behind necks and with heat.
pub(crate) fn without_branches<S: Scalar>(
    components: &Components<S>,
    pressures: [S; 2],
    [a, b]: [S; 2],
) -> [S; 2] {
    let [gas_a, gas_b] = components.branch_compliance(pressures);
    [a - gas_a, b - gas_b]
}

/// Whether gas lies behind a neck or a valve or exchanges heat.
pub(crate) fn has_gas_states(declared: &project::DeclaredActuator) -> bool {
    let gas = [&declared.line.a, &declared.line.b].map(|line| line.accumulator.as_ref());
    gas.into_iter().flatten().any(|gas| {
        let valve = gas.adjustment.as_ref().and_then(DeclaredAdjustment::valve);
        gas.neck.is_some() || gas.thermal_time_constant.is_some() || valve.is_some()
    })
}

/// The parameters of the linear model that the project states: name and value.
pub fn stated(parameters: &[ResolvedParameter]) -> impl Iterator<Item = (&'static str, f64)> {
    let stated = parameters.iter().filter(|one| one.origin != ParameterOrigin::Derived);
    stated.map(|one| (one.name, one.value))
}
