//! Servovalve: four edges with their leakage, a second-order spool, and the evaluation of data
//! sheets.

mod checks;
mod coefficients;
mod component;
mod edge_keys;
mod flow;
mod identification;
mod keys;
mod oil_temperature;
mod opening;
mod ports;
mod slow_motion;
mod spool;
mod tare;
mod test_stand;

pub use keys::{LEAKAGE_MODELS, NullLeakage, RatedFlow, Valve, ValveCoefficients, ValveLap};

pub(crate) use coefficients::supply_coefficients;
pub use coefficients::{
    ChamberCoefficients, ControlCoefficients, SpoolDirection, SupplyCoefficients, chamber_coefficients,
    control_coefficients, velocity_gain,
};
pub use flow::{
    ChamberFlows, EdgeFlows, LeakageModel, chamber_flows, control_flow, edge_conductances, edge_flows,
    hyperbolic_secant,
};
pub use identification::{
    PortCircuit, STATIC_COEFFICIENTS, Sensitive, StaticCoefficients, TestInput, TestOutput, TestedValve,
    ValveTerms,
};
pub use oil_temperature::{OilLaw, WarmOil};
pub use opening::{LeakageShape, OpeningLaw, OpeningShape, Openings};
pub use ports::{PortState, blocked_ports, connected_ports};
pub use slow_motion::{SlowSpool, ramp_delay};
pub use spool::{SpoolImperfection, SpoolState};
pub use tare::tare_flow;
pub use test_stand::{StandState, TestStand};

use phea_dynamics::scalar::Scalar;

use crate::parameter::{ParameterError, ParameterRequirement, Problems};
use crate::power_unit::{TANK_PRESSURE_KEY, drives_nothing};

/// Set of one number for each of the valve's four edges; the thesis numbers them 3, 4, 5, 6 in this
/// order.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Edges<S = f64> {
    /// Edge 3, from supply to A.
    pub supply_to_a: S,
    /// Edge 4, from A to tank.
    pub a_to_tank: S,
    /// Edge 5, from supply to B.
    pub supply_to_b: S,
    /// Edge 6, from B to tank.
    pub b_to_tank: S,
}

phea_dynamics::parameters! { Edges { supply_to_a, a_to_tank, supply_to_b, b_to_tank } }

impl<S: Copy> Edges<S> {
    /// Equal numbers for all four edges.
    ///
    /// ```text
    /// K_v3 = K_v4 = K_v5 = K_v6 = K_vp                 thesis (4.15)
    /// K_vin3 = K_vin4 = K_vin5 = K_vin6 = K_vinp       thesis (4.16)
    /// ```
    pub fn equal(value: S) -> Edges<S> {
        Edges { supply_to_a: value, a_to_tank: value, supply_to_b: value, b_to_tank: value }
    }

    /// Edges from numbers in the order 3, 4, 5, 6.
    pub fn from_array([supply_to_a, a_to_tank, supply_to_b, b_to_tank]: [S; 4]) -> Edges<S> {
        Edges { supply_to_a, a_to_tank, supply_to_b, b_to_tank }
    }

    /// All four numbers, mutable.
    pub fn each_mut(&mut self) -> [&mut S; 4] {
        [&mut self.supply_to_a, &mut self.a_to_tank, &mut self.supply_to_b, &mut self.b_to_tank]
    }

    /// Numbers in the order 3, 4, 5, 6.
    pub fn to_array(&self) -> [S; 4] {
        [self.supply_to_a, self.a_to_tank, self.supply_to_b, self.b_to_tank]
    }
}

impl<S: Scalar> Edges<S> {
    /// Leakage of an ideal valve, whose edges are shut at null: the limit of vanishing equal
    /// leakage, m3/(s Pa^0.5).
    ///
    /// ```text
    /// G_3 = G_4 = G_5 = G_6 = g:      g root(p_S - p) = g root(p - p_T),      p_A = p_B = (p_S + p_T)/2             for every g > 0
    /// K_c = g/sqrt(2 (p_S - p_T))  ->  0,      K_qU = K_v sqrt((p_S - p_T)/2)/U_Cn
    /// ```
    ///
    /// Without any leakage every pressure of a chamber is an equilibrium. The limit has a unique
    /// one; under a load, its pressures also satisfy p_A + p_B = p_S + p_T if the edges have equal
    /// flow coefficients.
    pub fn vanishing() -> Edges<S> {
        Edges::equal(S::from(VANISHING))
    }
}

/// Four-way servovalve with a second-order spool. Units: m3/(s Pa^0.5), m3/s, V, rad/s, Pa.
///
/// ```text
/// U_C = (1/w_nv^2) d2U_Csp/dt2 + (2 xi_v/w_nv) dU_Csp/dt + U_Csp       thesis (4.1)
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Servovalve<S = f64> {
    /// Flow coefficients K_v3 to K_v6, m3/(s Pa^0.5).
    pub flow_coefficients: Edges<S>,
    /// Opening of the edges by the spool.
    pub opening: OpeningLaw<S>,
    /// Leakage coefficients K_vin3 to K_vin6 at null, m3/(s Pa^0.5).
    pub leakage_coefficients: Edges<S>,
    /// Shape lambda of the leakage over the spool position.
    pub leakage_shape: LeakageShape<S>,
    /// Meaning of lambda and the leakage coefficients away from null.
    pub leakage_model: LeakageModel,
    /// Flow of the hydraulic amplifier q_tare, m3/s; without effect on the motion.
    pub tare_flow: S,
    /// Pressure drop p_S - p_T at which the tare flow is stated, Pa.
    pub tare_reference_drop: S,
    /// Voltage of full opening U_Cn, V.
    pub nominal_voltage: S,
    /// Natural frequency w_nv of the spool, rad/s.
    pub natural_frequency: S,
    /// Damping ratio xi_v of the spool.
    pub damping_ratio: S,
    /// Drop below which an edge's flow is laminar, Pa: [`crate::orifice::regular_root`].
    pub transition_pressure: S,
    /// Null bias, hysteresis, threshold and rate limit of the spool.
    pub spool: SpoolImperfection<S>,
}

/// Leakage of an edge of an ideal valve, m3/(s Pa^0.5): 10^-7 of that of ordinary edges. The spool
/// that holds a load is then 1e-9 of its travel from null, which rounding resolves.
const VANISHING: f64 = 1e-16;

/// Pressures at the valve's supply and tank ports, Pa gauge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Supply<S = f64> {
    /// Supply pressure p_S, Pa.
    pub pressure: S,
    /// Tank pressure p_T, Pa.
    pub tank_pressure: S,
}

impl Servovalve {
    /// Impossible parameters of this valve; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        const NAMES: [&str; 4] = ["supply_to_a", "a_to_tank", "supply_to_b", "b_to_tank"];
        let mut problems = Problems::default();
        for (name, value) in NAMES.into_iter().zip(self.flow_coefficients.to_array()) {
            problems.positive(&format!("flow_coefficients.{name}"), value);
        }
        for (name, value) in NAMES.into_iter().zip(self.leakage_coefficients.to_array()) {
            problems.positive(&format!("leakage_coefficients.{name}"), value);
        }
        if let OpeningLaw::Shaped(shape) = &self.opening {
            shape.check(&mut problems);
        }
        match self.leakage_shape {
            LeakageShape::Common(shape) => problems.key(keys::LEAKAGE_SHAPE_KEY, shape),
            LeakageShape::ByEdge(shapes) => {
                for (name, value) in NAMES.into_iter().zip(shapes.to_array()) {
                    problems.not_negative(&format!("leakage_shapes.{name}"), value);
                }
            }
        }
        problems.key(keys::TARE_FLOW_KEY, self.tare_flow);
        problems.key_as("tare_reference_drop", keys::TARE_PRESSURE_KEY, self.tare_reference_drop);
        problems.key(keys::NOMINAL_VOLTAGE_KEY, self.nominal_voltage);
        problems.key(keys::NATURAL_FREQUENCY_KEY, self.natural_frequency);
        problems.key(keys::DAMPING_RATIO_KEY, self.damping_ratio);
        problems.key(keys::TRANSITION_PRESSURE_KEY, self.transition_pressure);
        problems.all(self.spool.problems());
        problems.into_vec()
    }
}

phea_dynamics::parameters! {
    Servovalve {
        flow_coefficients, opening, leakage_coefficients, leakage_shape, leakage_model: kept, tare_flow,
        tare_reference_drop, nominal_voltage, natural_frequency, damping_ratio, transition_pressure, spool,
    }
}

phea_dynamics::parameters! { Supply { pressure, tank_pressure } }

impl Supply {
    /// Impossible parameters of this supply; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        let Supply { pressure, tank_pressure } = *self;
        problems.key(TANK_PRESSURE_KEY, tank_pressure);
        problems.require(
            "pressure",
            pressure,
            !drives_nothing(pressure, tank_pressure),
            ParameterRequirement::AboveTankPressure,
        );
        problems.into_vec()
    }
}

/// Flow coefficient of one edge from rated flow and rated drop over the whole valve, m3/(s Pa^0.5).
///
/// ```text
/// K_vp = q_vn / sqrt(dp_tn / 2)                                        thesis (4.12), corrected
/// ```
///
/// The drop divides equally between two equal edges in series. Flow in m3/s at full opening, drop
/// in Pa.
///
/// # Example
/// Example: 88 % of 10 gpm at 70 bar.
/// ```
/// use phea_hydraulics::servovalve::flow_coefficient_from_rating;
/// assert!((flow_coefficient_from_rating(0.88 * 6.31e-4, 7e6) - 2.97e-7_f64).abs() < 0.5e-9);
/// ```
pub fn flow_coefficient_from_rating<S: Scalar>(rated_flow: S, rated_drop: S) -> S {
    rated_flow / (rated_drop / S::from(2.0)).sqrt()
}

/// Leakage coefficient of one edge from the leakage at null, m3/(s Pa^0.5).
///
/// ```text
/// K_vinp = (q_total - q_tare sqrt(p_in/p_tare)) / sqrt(2 p_in)         thesis (4.13), the tare flow subtracted
/// ```
///
/// Catalogues state the whole leakage, including the amplifier's tare flow; the remainder flows
/// through two paths of two edges. Flows in m3/s, the leakage at the pressure p_in and the tare
/// flow, which is proportional to the root of the pressure, at p_tare, both in Pa.
///
/// # Example
/// Examples: 0.61 gpm less 0.26 gpm, both at 3000 psi; 0.40 gpm at 3000 psi less a measurement at
/// 70 bar.
/// ```
/// use phea_hydraulics::servovalve::leakage_coefficient_from_rating;
/// let coefficient: f64 = leakage_coefficient_from_rating(3.84e-5, 1.64e-5, 2.068e7, 2.068e7);
/// assert!((coefficient - 3.42e-9).abs() < 0.5e-11);
/// let measured: f64 = leakage_coefficient_from_rating(2.5236e-5, 7.55e-6, 70e5, 2.0684e7);
/// assert!((measured - 1.906e-9).abs() < 0.5e-12); // ORIGIN: recomputed by comparisons/recompute_rig.py
/// ```
pub fn leakage_coefficient_from_rating<S: Scalar>(
    total_leakage: S,
    tare_flow: S,
    tare_pressure: S,
    pressure: S,
) -> S {
    let tare = tare_flow * (pressure / tare_pressure).sqrt();
    (total_leakage - tare) / (S::from(2.0) * pressure).sqrt()
}
