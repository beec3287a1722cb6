//! Servovalve on a test bench: its ports blocked, or connected to each other through a meter.

use phea_dynamics::scalar::{LocalFunction, Parameters, Scalar};

use super::{PortCircuit, Servovalve, Supply, edge_conductances};
use crate::orifice::{self, regular_root, regular_root_slope};

/// Equilibrium of a valve at rest on a test bench. Units: Pa, m3/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PortState<S = f64> {
    /// Pressure p_A at port A.
    pub pressure_a: S,
    /// Pressure p_B at port B.
    pub pressure_b: S,
    /// Flow through the edges from the supply, q_v3 + q_v5, without the tare flow.
    pub supply_flow: S,
    /// Flow out of port A into port B, q_v3 - q_v4; zero if the ports are blocked.
    pub port_flow: S,
}

/// Newton steps after a start that is exact for a square root; each squares an error that is below
/// 1e-4 before the first.
const POLISHING_STEPS: usize = 3;

/// Relative conductance of a shut edge: it keeps derivatives finite without an effect on the
/// pressures.
const CLOSED: f64 = 1e-60;

/// Newton steps if a load pressure separates the two halves of the valve.
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
/// Equal edges at null hold half the supply pressure in both ports:
/// ```
/// use phea_hydraulics::reference_rig::valve;
/// use phea_hydraulics::servovalve::{Edges, Servovalve, Supply, blocked_ports};
/// let valve = Servovalve {
///     flow_coefficients: Edges::equal(2.97e-7), leakage_coefficients: Edges::equal(2.48e-9), ..valve()
/// };
/// let supply = Supply { pressure: 70e5, tank_pressure: 0.0 };
/// let found = blocked_ports(&valve, &supply, 0.0);
/// assert!((found.pressure_a - 35e5).abs() < 1e-3 && (found.pressure_b - 35e5).abs() < 1e-3);
/// assert!((found.supply_flow / (2.48e-9 * 140e5_f64.sqrt()) - 1.0).abs() < 1e-6); // thesis (4.13)
/// ```
pub fn blocked_ports<S: Scalar>(valve: &Servovalve<S>, supply: &Supply<S>, opening: S) -> PortState<S> {
    let edges = edge_conductances(valve, opening).to_array();
    let [supply_a, tank_a, supply_b, tank_b] = edges;
    let whole = supply.pressure - supply.tank_pressure;
    let transition = valve.transition_pressure;
    let of = |from_supply, to_tank| supply.tank_pressure + divided(from_supply, to_tank, whole, transition);
    state(edges, supply, transition, [of(supply_a, tank_a), of(supply_b, tank_b)], S::from(0.0))
}

/// Ports connected to each other with the load pressure p_A - p_B between them in Pa, zero without
/// a meter: the metering test of ISO 10770-1.
///
/// ```text
/// q_v3(p_A) + q_v5(p_B) = q_v4(p_A) + q_v6(p_B)        p_A - p_B = p_L
/// ```
///
/// A load pressure beyond the supply's is meaningless here. `opening` as in [`blocked_ports`].
///
/// # Example
/// Edges 3 and 6 in series pass the flow of 4.12:
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
    let edges = edge_conductances(valve, opening).to_array();
    let [supply_a, tank_a, supply_b, tank_b] = edges;
    let transition = valve.transition_pressure;
    let half = load_pressure * S::from(0.5);
    // drop over the two metering edges, divided as without a load
    let metered = supply.pressure - supply.tank_pressure - load_pressure.abs();
    let start = divided(supply_a + supply_b, tank_a + tank_b, metered, transition);
    let mut mean = supply.tank_pressure + start + half.abs();
    for _ in 0..LOADED_STEPS {
        mean = mean - imbalance(edges, supply, transition, [mean + half, mean - half]);
    }
    state(edges, supply, transition, [mean + half, mean - half], S::from(1.0))
}

/// Port pressures from one Newton step at their known values: over numbers with derivatives, it
/// gives the derivatives of the solution.
pub(super) struct KnownPorts {
    /// Piping of the ports.
    pub(super) circuit: PortCircuit,
    /// Supply and tank.
    pub(super) supply: Supply,
    /// Drop below which an edge's flow is laminar, Pa.
    pub(super) transition_pressure: f64,
    /// Known pressures p_A and p_B, Pa.
    pub(super) pressures: [f64; 2],
}

/// Function of the four conductances: p_A, p_B, flow from the supply, flow from port to port.
impl LocalFunction<f64, 4, 4> for KnownPorts {
    fn at<T: Scalar>(&self, edges: [T; 4], constant: impl Fn(f64) -> T + Copy) -> [T; 4] {
        let supply = self.supply.convert(&mut |pressure| constant(pressure));
        let transition = constant(self.transition_pressure);
        let [a, b] = self.pressures.map(constant);
        let none = constant(0.0);
        let [three, four, five, six] = edges;
        let (pressures, connected) = match self.circuit {
            PortCircuit::Blocked => {
                let of_a = imbalance([three, four, none, none], &supply, transition, [a, a]);
                let of_b = imbalance([none, none, five, six], &supply, transition, [b, b]);
                ([a - of_a, b - of_b], none)
            }
            PortCircuit::Connected => {
                let of_both = imbalance(edges, &supply, transition, [a, b]);
                ([a - of_both, b - of_both], constant(1.0))
            }
        };
        let found = state(edges, &supply, transition, pressures, connected);
        [found.pressure_a, found.pressure_b, found.supply_flow, found.port_flow]
    }
}

/// Newton step of the pressures, moved together, towards a balance of the flows into the ports, Pa.
///
/// ```text
/// (q_4 + q_6 - q_3 - q_5)/(q_4' + q_6' + q_3' + q_5')              primes denote the slope over the edge's own drop
/// ```
fn imbalance<S: Scalar>(edges: [S; 4], supply: &Supply<S>, transition: S, [a, b]: [S; 2]) -> S {
    let drops =
        [supply.pressure - a, a - supply.tank_pressure, supply.pressure - b, b - supply.tank_pressure];
    let mut surplus = S::from(0.0);
    let mut slope = S::from(0.0);
    for ((edge, drop), sign) in edges.into_iter().zip(drops).zip([-1.0, 1.0, -1.0, 1.0]) {
        surplus = surplus + edge * regular_root(drop, transition).times(sign);
        slope = slope + edge * regular_root_slope(drop, transition);
    }
    surplus / slope
}

/// Pressure between two edges in series relative to that behind the second, Pa.
///
/// ```text
/// G_1 root(P - p) = G_2 root(p)        solved for the smaller drop d:  root(d) = k root(P - d),  k = G_small/G_large
/// ```
///
/// The root has a closed inverse, d^2 = h^2 (h^2 + sqrt(h^4 + 4 dp_t^2))/2 for root(d) = h.
fn divided<S: Scalar>(first: S, second: S, whole: S, transition: S) -> S {
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
    [supply_a, tank_a, supply_b, _]: [S; 4],
    supply: &Supply<S>,
    transition: S,
    [pressure_a, pressure_b]: [S; 2],
    connected: S,
) -> PortState<S> {
    let from_supply_a = orifice::flow(supply_a, supply.pressure - pressure_a, transition);
    let from_supply_b = orifice::flow(supply_b, supply.pressure - pressure_b, transition);
    let into_tank_a = orifice::flow(tank_a, pressure_a - supply.tank_pressure, transition);
    PortState {
        pressure_a,
        pressure_b,
        supply_flow: from_supply_a + from_supply_b,
        port_flow: connected * (from_supply_a - into_tank_a),
    }
}
