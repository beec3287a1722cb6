use phea_dynamics::scalar::Scalar;

use super::{Edges, Servovalve, Supply};
use crate::orifice;

/// Relative openings of the edges that the spool moves, both 0 to 1, and the relative leakage it
/// leaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Openings<S> {
    /// Of edges 3 and 6, supply to A and B to tank: U/U_n where U > 0.
    pub forward: S,
    /// Of edges 4 and 5, A to tank and supply to B: -U/U_n where U < 0.
    pub backward: S,
    /// Leakage over leakage at null: sech(lambda U/U_n).
    pub leakage: S,
}

impl<S: Scalar> Openings<S> {
    /// At spool position U_Csp in V.
    ///
    /// The positive part is (U + |U|)/2 and the negative (|U| - U)/2, so that a derivative taken
    /// exactly at U = 0 is the mean of the two one-sided ones.
    #[inline(always)]
    pub fn at(valve: &Servovalve<S>, spool: S) -> Openings<S> {
        let relative = spool / valve.nominal_voltage;
        let half = S::from(0.5);
        Openings {
            forward: half * (relative.abs() + relative),
            backward: half * (relative.abs() - relative),
            leakage: hyperbolic_secant(valve.leakage_shape * relative),
        }
    }
}

/// Flows through the four edges in m3/s, each positive from its first named port to its second.
pub type EdgeFlows<S> = Edges<S>;

/// Flows into the two chambers in m3/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChamberFlows<S> {
    /// Into chamber A.
    pub into_a: S,
    /// Into chamber B (the thesis counts q_vB the other way round).
    pub into_b: S,
}

/// Hyperbolic secant 2/(e^y + e^-y), without overflow.
///
/// # Example
/// ```
/// use phea_hydraulics::servovalve::hyperbolic_secant;
/// assert_eq!(hyperbolic_secant(0.0), 1.0);
/// assert_eq!(hyperbolic_secant(-1e4), 0.0);
/// assert!((hyperbolic_secant(1.0_f64) - 0.6480542736638855).abs() < 1e-15);
/// ```
#[inline(always)]
pub fn hyperbolic_secant<S: Scalar>(argument: S) -> S {
    let decay = (-argument.abs()).exp();
    S::from(2.0) * decay / (S::from(1.0) + decay.squared())
}

/// Flows through the four edges, in m3/s.
///
/// ```text
/// q_v3 = (K_v3 u+ + K_vin3 sech(lambda u)) root(p_S - p_A)             thesis (4.2), (4.6)
/// q_v4 = (K_v4 u- + K_vin4 sech(lambda u)) root(p_A - p_T)             thesis (4.3), (4.7)
/// q_v5 = (K_v5 u- + K_vin5 sech(lambda u)) root(p_S - p_B)             thesis (4.4), (4.8)
/// q_v6 = (K_v6 u+ + K_vin6 sech(lambda u)) root(p_B - p_T)             thesis (4.5), (4.9)
/// ```
///
/// with u = U_Csp/U_Cn, its positive and negative parts u+ and u-, and the regular root of
/// [`crate::orifice`]. The leakage's shape is that of thesis (4.14), here on each edge. `spool` in
/// V, pressures in Pa.
#[inline(always)]
pub fn edge_flows<S: Scalar>(
    valve: &Servovalve<S>,
    supply: &Supply<S>,
    openings: &Openings<S>,
    pressure_a: S,
    pressure_b: S,
) -> EdgeFlows<S> {
    let (flow, leakage, transition) =
        (&valve.flow_coefficients, &valve.leakage_coefficients, valve.transition_pressure);
    let (out_of_supply_a, into_tank_a) = (supply.pressure - pressure_a, pressure_a - supply.tank_pressure);
    let (out_of_supply_b, into_tank_b) = (supply.pressure - pressure_b, pressure_b - supply.tank_pressure);
    let Openings { forward, backward, leakage: shape } = *openings;
    Edges {
        supply_to_a: orifice::flow(
            flow.supply_to_a * forward + leakage.supply_to_a * shape,
            out_of_supply_a,
            transition,
        ),
        a_to_tank: orifice::flow(
            flow.a_to_tank * backward + leakage.a_to_tank * shape,
            into_tank_a,
            transition,
        ),
        supply_to_b: orifice::flow(
            flow.supply_to_b * backward + leakage.supply_to_b * shape,
            out_of_supply_b,
            transition,
        ),
        b_to_tank: orifice::flow(
            flow.b_to_tank * forward + leakage.b_to_tank * shape,
            into_tank_b,
            transition,
        ),
    }
}

/// Flows into both chambers, in m3/s, at spool position U_Csp in V and chamber pressures in Pa.
///
/// ```text
/// q_A = q_v3 - q_v4        q_B = q_v5 - q_v6                           thesis (4.10), (4.11)
/// ```
///
/// The thesis counts q_vB out of chamber B; here both are positive into their chamber.
///
/// # Example
/// Equal edges at null and half the supply pressure: what leaks in leaks out.
/// ```
/// use phea_hydraulics::servovalve::{Edges, Servovalve, Supply, chamber_flows};
/// let valve = Servovalve {
///     flow_coefficients: Edges::equal(2.97e-7), leakage_coefficients: Edges::equal(2.48e-9),
///     leakage_shape: 100.0, tare_flow: 7.55e-6, nominal_voltage: 10.0,
///     natural_frequency: 1099.0, damping_ratio: 0.9, transition_pressure: 1e3,
/// };
/// let supply = Supply { pressure: 70e5, tank_pressure: 0.0 };
/// let flows = chamber_flows(&valve, &supply, 0.0, 35e5, 35e5);
/// assert_eq!((flows.into_a, flows.into_b), (0.0, 0.0));
/// let open = chamber_flows(&valve, &supply, 1.0, 35e5, 35e5);
/// assert!(open.into_a > 5e-5 && open.into_b == -open.into_a);
/// ```
pub fn chamber_flows<S: Scalar>(
    valve: &Servovalve<S>,
    supply: &Supply<S>,
    spool: S,
    pressure_a: S,
    pressure_b: S,
) -> ChamberFlows<S> {
    let edges = edge_flows(valve, supply, &Openings::at(valve, spool), pressure_a, pressure_b);
    ChamberFlows { into_a: edges.supply_to_a - edges.a_to_tank, into_b: edges.supply_to_b - edges.b_to_tank }
}

/// Control flow q_vC of a valve with equal edges on a symmetric cylinder, in m3/s, positive for U >
/// 0.
///
/// ```text
/// q_vC = (q_A - q_B)/2   with  p_A, p_B = (p_S + p_T +- p_L)/2         thesis (4.17), (4.18)
/// ```
pub fn control_flow<S: Scalar>(valve: &Servovalve<S>, supply: &Supply<S>, spool: S, load_pressure: S) -> S {
    let mean = supply.pressure + supply.tank_pressure;
    let half = S::from(0.5);
    let (pressure_a, pressure_b) = (half * (mean + load_pressure), half * (mean - load_pressure));
    let flows = chamber_flows(valve, supply, spool, pressure_a, pressure_b);
    half * (flows.into_a - flows.into_b)
}
