//! The linear plant of a rig at its operating point, with its load, its leakage and the parameters
//! that the project states, over any scalar.

use phea_dynamics::scalar::Scalar;
use phea_hydraulics::accumulator::GasBranch;
use phea_hydraulics::actuator::Components;
use phea_hydraulics::plant::{ChamberDynamics, LinearPlant, LinearSeries, VelocitySensor, YieldingSupply};
use phea_hydraulics::servovalve::ChamberCoefficients;
use phea_hydraulics::two_pressure::TwoPressureLinearParameters;

use super::at_point::RigAtPoint;
use super::parameters::{ParameterOrigin, ResolvedParameter};
use crate::project::{self, DeclaredAdjustment};

/// Parameters of the linear model that presuppose one load pressure.
const OF_LOAD_PRESSURE: [&str; 4] =
    ["piston_area", "flow_gain", "flow_pressure_coefficient", "hydraulic_stiffness"];
/// Chambers whose numbers differ by less, relative to them, are equal.
const EQUAL: f64 = 1e-9;

/// Equalities between both sides of a plant, or of every plant of a family. They are decided by
/// numbers and given to the plant, whose equations do not branch on a value.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Equal {
    /// Both chambers are equal, or their parameters are stated: one load pressure describes them.
    pub(crate) one_pressure: bool,
    /// Both chambers follow the pressure of the supply alike, so that it does not affect the
    /// difference of their pressures.
    pub(crate) unseen: bool,
}

impl Equal {
    /// Equalities of a rig with equal chambers, with equal coupling of both to the supply, and with
    /// a stated parameter that presupposes one load pressure. Gas with states of its own makes the
    /// chambers differ.
    pub(crate) fn new(
        declared: &project::DeclaredActuator,
        [chambers, edges]: [bool; 2],
        is_stated: bool,
    ) -> Equal {
        let unseen = edges && !has_gas_states(declared);
        Equal { one_pressure: is_stated || chambers && unseen, unseen }
    }
}

impl<S: Scalar> RigAtPoint<S> {
    /// The linear plant with lumped lines, without what the loop adds to it.
    pub(crate) fn plant(&self, equal: Equal) -> LinearPlant<S> {
        let RigAtPoint { components, point, linear, .. } = self;
        let pressures = [point.pressure_a, point.pressure_b];
        let chambers = match equal.one_pressure {
            true => ChamberDynamics::from(linear),
            false => ChamberDynamics::from(&self.chambers),
        };
        let supply = self.supply.filter(|_| !(equal.one_pressure && equal.unseen));
        let supply = supply.map(|supply| self.supply_of(&chambers, supply));
        let (chambers, gas) = self.with_gas(chambers, pressures);
        LinearPlant {
            valve_natural_frequency: linear.valve_natural_frequency,
            valve_damping_ratio: linear.valve_damping_ratio,
            chambers,
            internal_leakage: self.leakage,
            dynamic_feedback: self.dynamic_feedback,
            gas,
            moving_mass: linear.moving_mass,
            viscous_friction: linear.viscous_friction,
            sensor_stiffness: linear.sensor_stiffness,
            load: self.load,
            supply,
            velocity_sensor: VelocitySensor { gain: components.velocity_gain, ..VelocitySensor::default() },
            series: LinearSeries::of_components(components, point.hydraulic_force),
            area_stiffness: components.cylinder.area_stiffness(point.position, pressures),
            load_velocity_feed_forward: None,
            virtual_impedance: None,
            pressure_feedback: None,
            pressure_signal: None,
        }
    }

    /// A limited supply of these chambers. Where a stated number changes the valve in the model
    /// with one load pressure, the flow from the supply changes in proportion.
    fn supply_of(&self, chambers: &ChamberDynamics<S>, supply: YieldingSupply<S>) -> YieldingSupply<S> {
        match *chambers {
            ChamberDynamics::TwoPressures { .. } => supply,
            ChamberDynamics::LoadPressure { flow_gain, flow_pressure_coefficient, .. } => {
                let (two, own) = (S::from(2.0), &self.leaking);
                let both = two * flow_pressure_coefficient;
                let [edge_a, edge_b] = supply.edges;
                YieldingSupply {
                    edges: [edge_a * both / own.flow_pressure_a, edge_b * both / own.flow_pressure_b],
                    flow_gain: supply.flow_gain * two * flow_gain / (own.flow_gain_a + own.flow_gain_b),
                    ..supply
                }
            }
        }
    }

    /// Chambers next to the gas of accumulators that lies behind a neck or a valve or exchanges
    /// heat, and that gas: a pressure a chamber. Where a stated number makes the chambers stiffer
    /// than their parts are, the gas is stiffened alike.
    fn with_gas(
        &self,
        dynamics: ChamberDynamics<S>,
        pressures: [S; 2],
    ) -> (ChamberDynamics<S>, [Option<GasBranch<S>>; 2]) {
        let RigAtPoint { components, chambers, .. } = self;
        let gas = components.gas_branches(pressures);
        if gas.iter().all(Option::is_none) {
            return (dynamics, gas);
        }
        let alone = without_branches(components, pressures, chambers.compliances);
        match dynamics {
            ChamberDynamics::TwoPressures { areas, flow_gains, flow_pressures, .. } => {
                let compliances = alone;
                (ChamberDynamics::TwoPressures { areas, compliances, flow_gains, flow_pressures }, gas)
            }
            ChamberDynamics::LoadPressure {
                useful_area,
                flow_gain,
                flow_pressure_coefficient,
                hydraulic_stiffness,
            } => {
                let two = S::from(2.0);
                let stated = two * useful_area.squared() / hydraulic_stiffness;
                let [fraction_a, fraction_b] = chambers.compliances.map(|own| stated / own);
                let [gas_a, gas_b] = gas;
                let chambers = ChamberDynamics::TwoPressures {
                    areas: [useful_area; 2],
                    compliances: [alone[0] * fraction_a, alone[1] * fraction_b],
                    flow_gains: [flow_gain; 2],
                    flow_pressures: [two * flow_pressure_coefficient; 2],
                };
                (
                    chambers,
                    [gas_a.map(|gas| gas.softened(fraction_a)), gas_b.map(|gas| gas.softened(fraction_b))],
                )
            }
        }
    }
}

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
pub(crate) fn sides<S: Scalar>(chambers: &TwoPressureLinearParameters<S>) -> [[S; 2]; 3] {
    let ChamberCoefficients { flow_pressure_a, flow_pressure_b, .. } = chambers.chambers;
    [chambers.areas, chambers.compliances, [flow_pressure_a, flow_pressure_b]]
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
fn has_gas_states(declared: &project::DeclaredActuator) -> bool {
    let gas = [&declared.line.a, &declared.line.b].map(|line| line.accumulator.as_ref());
    gas.into_iter().flatten().any(|gas| {
        let valve = gas.adjustment.as_ref().and_then(DeclaredAdjustment::valve);
        gas.neck.is_some() || gas.thermal_time_constant.is_some() || valve.is_some()
    })
}
