//! A servovalve on a test bench: its ports blocked, or connected to each other through a meter.

use phea_dynamics::scalar::Scalar;

use super::{Openings, Servovalve, Supply, edge_flows};
use crate::orifice::{regular_root, regular_root_slope};

/// Where a valve at rest settles on a test bench. Units: Pa, m3/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PortState<S = f64> {
    /// Pressure p_A at port A.
    pub pressure_a: S,
    /// Pressure p_B at port B.
    pub pressure_b: S,
    /// Flow through the edges from the supply, q_v3 + q_v5; the tare flow comes on top.
    pub supply_flow: S,
    /// Flow out of port A into port B, q_v3 - q_v4; zero where the ports are blocked.
    pub port_flow: S,
}

/// Steps of Newton's method after a start that is exact for a square root; each squares an error
/// that is below 1e-4 before the first.
const POLISHING_STEPS: usize = 3;

/// Relative conductance of an edge that is shut: it keeps derivatives finite and moves no pressure.
const CLOSED: f64 = 1e-60;

/// Steps where a load pressure keeps the two halves of the valve apart.
const LOADED_STEPS: usize = 6;

/// Ports blocked: the internal leakage test and the pressure gain test of ISO 10770-1.
///
/// ```text
/// q_v3(p_A) = q_v4(p_A)        q_v5(p_B) = q_v6(p_B)
/// ```
///
/// `opening` is the position of the edges, U_Csp less null bias and lag, in V. Source: thesis (4.2)
/// to (4.9) with q_vA = q_vB = 0.
///
/// # Example
/// Equal edges at null hold half the supply pressure in both ports.
/// ```
/// use phea_hydraulics::servovalve::{Edges, Servovalve, Supply, blocked_ports};
/// let valve = Servovalve {
///     flow_coefficients: Edges::equal(2.97e-7), leakage_coefficients: Edges::equal(2.48e-9),
///     leakage_shape: 100.0, tare_flow: 7.55e-6, nominal_voltage: 10.0,
///     natural_frequency: 1099.0, damping_ratio: 0.9, transition_pressure: 1e3,
/// };
/// let supply = Supply { pressure: 70e5, tank_pressure: 0.0 };
/// let found = blocked_ports(&valve, &supply, 0.0);
/// assert!((found.pressure_a - 35e5).abs() < 1e-3 && (found.pressure_b - 35e5).abs() < 1e-3);
/// assert!((found.supply_flow / (2.48e-9 * 140e5_f64.sqrt()) - 1.0).abs() < 1e-6); // thesis (4.13)
/// ```
pub fn blocked_ports<S: Scalar>(valve: &Servovalve<S>, supply: &Supply<S>, opening: S) -> PortState<S> {
    let [supply_a, tank_a, supply_b, tank_b] = conductances(valve, opening);
    let whole = supply.pressure - supply.tank_pressure;
    let of = |from_supply, to_tank| supply.tank_pressure + divided(from_supply, to_tank, whole, valve);
    state(valve, supply, opening, [of(supply_a, tank_a), of(supply_b, tank_b)], S::from(0.0))
}

/// Ports connected to each other with the load pressure p_A - p_B between them in Pa, zero without a
/// meter: the metering test of ISO 10770-1.
///
/// ```text
/// q_v3(p_A) + q_v5(p_B) = q_v4(p_A) + q_v6(p_B)        p_A - p_B = p_L
/// ```
///
/// A load pressure beyond the supply's has no meaning here. `opening` as in [`blocked_ports`].
///
/// # Example
/// Edges 3 and 6 in series pass the flow of 4.12.
/// ```
/// use phea_hydraulics::reference_rig::valve;
/// use phea_hydraulics::servovalve::{Edges, Servovalve, Supply, connected_ports};
/// let valve = Servovalve { flow_coefficients: Edges::equal(2.97e-7), ..valve() };
/// let supply = Supply { pressure: 70e5, tank_pressure: 0.0 };
/// let found: f64 = connected_ports(&valve, &supply, 10.0, 0.0).port_flow;
/// assert!((found / (2.97e-7 * 35e5_f64.sqrt()) - 1.0).abs() < 1e-6);
/// ```
pub fn connected_ports<S: Scalar>(
    valve: &Servovalve<S>,
    supply: &Supply<S>,
    opening: S,
    load_pressure: S,
) -> PortState<S> {
    let edges = conductances(valve, opening);
    let [supply_a, tank_a, supply_b, tank_b] = edges;
    let half = load_pressure * S::from(0.5);
    // the drop over the two edges that meter, shared as without a load
    let metered = supply.pressure - supply.tank_pressure - load_pressure.abs();
    let start = divided(supply_a + supply_b, tank_a + tank_b, metered, valve);
    let mut mean = supply.tank_pressure + start + half.abs();
    let transition = valve.transition_pressure;
    for _ in 0..LOADED_STEPS {
        let [a, b] = [mean + half, mean - half];
        let drops =
            [supply.pressure - a, a - supply.tank_pressure, supply.pressure - b, b - supply.tank_pressure];
        let mut surplus = S::from(0.0);
        let mut slope = S::from(0.0);
        for ((edge, drop), sign) in edges.into_iter().zip(drops).zip([-1.0, 1.0, -1.0, 1.0]) {
            surplus = surplus + edge * regular_root(drop, transition).times(sign);
            slope = slope + edge * regular_root_slope(drop, transition);
        }
        mean = mean - surplus / slope;
    }
    state(valve, supply, opening, [mean + half, mean - half], S::from(1.0))
}

/// What each edge passes at a root of one, in the order 3, 4, 5, 6, in m3/(s Pa^0.5).
fn conductances<S: Scalar>(valve: &Servovalve<S>, opening: S) -> [S; 4] {
    let Openings { forward, backward, leakage } = Openings::at(valve, opening);
    let [flow, leak] = [&valve.flow_coefficients, &valve.leakage_coefficients];
    [
        flow.supply_to_a * forward + leak.supply_to_a * leakage,
        flow.a_to_tank * backward + leak.a_to_tank * leakage,
        flow.supply_to_b * backward + leak.supply_to_b * leakage,
        flow.b_to_tank * forward + leak.b_to_tank * leakage,
    ]
}

/// Pressure between two edges in series above that behind the second, in Pa.
///
/// ```text
/// G_1 root(P - p) = G_2 root(p)        solved for the smaller drop d:  root(d) = k root(P - d),  k = G_small/G_large
/// ```
///
/// The root has a closed inverse, d^2 = h^2 (h^2 + sqrt(h^4 + 4 dp_t^2))/2 for root(d) = h.
fn divided<S: Scalar>(first: S, second: S, whole: S, valve: &Servovalve<S>) -> S {
    let transition = valve.transition_pressure;
    let tank_is_wider = first.less_than(second);
    let [wide, narrow] = [S::select(tank_is_wider, second, first), S::select(tank_is_wider, first, second)];
    let ratio = (narrow / wide).maximum(S::from(CLOSED));
    let without_transition = whole * ratio.squared() / (S::from(1.0) + ratio.squared());
    let height = (ratio * regular_root(whole - without_transition, transition)).squared();
    let both = (height.squared() + transition.squared().times(4.0)).sqrt();
    let mut drop = (height * (height + both) * S::from(0.5)).sqrt();
    for _ in 0..POLISHING_STEPS {
        let surplus = regular_root(drop, transition) - ratio * regular_root(whole - drop, transition);
        let slope =
            regular_root_slope(drop, transition) + ratio * regular_root_slope(whole - drop, transition);
        drop = drop - surplus / slope;
    }
    S::select(tank_is_wider, drop, whole - drop)
}

fn state<S: Scalar>(
    valve: &Servovalve<S>,
    supply: &Supply<S>,
    opening: S,
    [pressure_a, pressure_b]: [S; 2],
    connected: S,
) -> PortState<S> {
    let edges = edge_flows(valve, supply, &Openings::at(valve, opening), pressure_a, pressure_b);
    PortState {
        pressure_a,
        pressure_b,
        supply_flow: edges.supply_to_a + edges.supply_to_b,
        port_flow: connected * (edges.supply_to_a - edges.a_to_tank),
    }
}
