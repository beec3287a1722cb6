use phea_dynamics::scalar::Scalar;

use super::{Edges, Openings, Servovalve, Supply};
use crate::orifice;

/// Flows through the four edges, each positive from its first named port to its second, m3/s.
pub type EdgeFlows<S> = Edges<S>;

/// Flows into the two chambers, m3/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChamberFlows<S> {
    /// Flow into chamber A.
    pub into_a: S,
    /// Flow into chamber B (the thesis counts q_vB in the opposite sense).
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

/// Dependence of the leakage on the spool position.
///
/// The thesis states one curve for the leakage of the whole valve (4.14), and edges that close
/// independently (4.2 to 4.9). Both models have equal coefficients and flows at null; away from
/// null, a lambda and a K_vin identified with one model are not valid in the other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LeakageModel {
    /// Separate secants: the leakage of every edge is proportional to sech(lambda u).
    #[default]
    EachEdge,
    /// Common curve for the whole valve: with shut ports, its leakage is proportional to
    /// sech(lambda u).
    OneCurve,
}

/// Conductances of the edges, the flow at a root of one, m3/(s Pa^0.5), at spool position U_Csp in
/// V.
///
/// ```text
/// G_i = K_vi u+- + K_vini sech(lambda u)                                    each edge; thesis (4.2) to (4.9)
/// G_i = K_vi u+- + k sech G_j/sqrt(G_j^2 - k^2 sech^2)                      one curve, i the edge that closes
///       with G_j = K_vj u+- + K_vinj sech of the other edge at the same port, k = K_vini K_vinj/sqrt(K_vini^2 + K_vinj^2)
/// q_vin = K_vinp sech(lambda u) sqrt(2 (p_S - p_T))                         shut ports, one curve; thesis (4.14)
/// ```
///
/// with u+ for edges 3 and 6 and u- for 4 and 5, see [`super::OpeningLaw`], and each edge's own
/// lambda if they differ. With one curve two edges in series pass k sech sqrt(p_S - p_T) when their
/// port is shut, at any spool position, so that the whole leakage is that of thesis (4.14) with
/// K_vinp sqrt(2) the sum of both k. At null both are K_vini.
///
/// # Example
/// Leakage of equal edges away from null: one curve, and sqrt(2) times it:
/// ```
/// use phea_hydraulics::reference_rig::valve;
/// use phea_hydraulics::servovalve::{Edges, LeakageModel, Servovalve, edge_conductances, hyperbolic_secant};
/// let each = Servovalve { leakage_coefficients: Edges::equal(2.4e-9), ..valve() };
/// let one = Servovalve { leakage_model: LeakageModel::OneCurve, ..each };
/// let closing = |valve| edge_conductances(valve, 0.5).a_to_tank / (2.4e-9 * hyperbolic_secant(5.0));
/// assert!((closing(&each) - 1.0_f64).abs() < 1e-12);
/// assert!((closing(&one) - 0.5_f64.sqrt()).abs() < 1e-5);
/// ```
#[inline(always)]
pub fn edge_conductances<S: Scalar>(valve: &Servovalve<S>, spool: S) -> Edges<S> {
    let (flow, leak) = (&valve.flow_coefficients, &valve.leakage_coefficients);
    let Openings { forward, backward, leakage } = Openings::at(valve, spool);
    let (open_a, open_b) = (flow.supply_to_a * forward, flow.supply_to_b * backward);
    let (shut_a, shut_b) = (flow.a_to_tank * backward, flow.b_to_tank * forward);
    match valve.leakage_model {
        LeakageModel::EachEdge => Edges {
            supply_to_a: open_a + leak.supply_to_a * leakage.supply_to_a,
            a_to_tank: shut_a + leak.a_to_tank * leakage.a_to_tank,
            supply_to_b: open_b + leak.supply_to_b * leakage.supply_to_b,
            b_to_tank: shut_b + leak.b_to_tank * leakage.b_to_tank,
        },
        LeakageModel::OneCurve => {
            let leakage = left(leakage.supply_to_a);
            let of_a = [leak.supply_to_a, leak.a_to_tank];
            let of_b = [leak.supply_to_b, leak.b_to_tank];
            let [supply_to_a, a_to_tank] = in_series([open_a, shut_a], of_a, leakage);
            let [supply_to_b, b_to_tank] = in_series([open_b, shut_b], of_b, leakage);
            Edges { supply_to_a, a_to_tank, supply_to_b, b_to_tank }
        }
    }
}

/// Secant, bounded away from zero so that it can be a divisor: for edges that are permanently shut
/// the bound has no effect.
#[inline(always)]
pub(super) fn left<S: Scalar>(leakage: S) -> S {
    leakage.maximum(S::from(1e-60))
}

/// Conductances of two edges at one port, from their opening by the spool and their leakage at
/// null, if both together leak in one curve.
///
/// The rule of the closing edge also gives the conductance of the opening edge, whose partner is
/// then at its leakage: so the result does not depend on the direction.
#[inline(always)]
fn in_series<S: Scalar>([open, shut]: [S; 2], [first, second]: [S; 2], leakage: S) -> [S; 2] {
    let squares = first.squared() + second.squared();
    let series = first * second / squares.sqrt() * leakage;
    // G^2 - k^2 sech^2 without the difference of two large numbers
    let rest = |opened: S, own: S| {
        let own_squared = own.squared();
        opened * (opened + S::from(2.0) * own * leakage)
            + own_squared * own_squared / squares * leakage.squared()
    };
    let closing = |opened: S, own: S| series * (opened + own * leakage) / rest(opened, own).sqrt();
    [open + closing(shut, second), shut + closing(open, first)]
}

/// Flows through the four edges, m3/s.
///
/// ```text
/// q_v3 = G_3 root(p_S - p_A)        thesis (4.2), (4.6)        q_v4 = G_4 root(p_A - p_T)        thesis (4.3), (4.7)
/// q_v5 = G_5 root(p_S - p_B)        thesis (4.4), (4.8)        q_v6 = G_6 root(p_B - p_T)        thesis (4.5), (4.9)
/// ```
///
/// with the conductances of [`edge_conductances`] and the regular root of [`crate::orifice`].
/// Pressures in Pa.
#[inline(always)]
pub fn edge_flows<S: Scalar>(
    valve: &Servovalve<S>,
    supply: &Supply<S>,
    conductances: &Edges<S>,
    pressure_a: S,
    pressure_b: S,
) -> EdgeFlows<S> {
    let transition = valve.transition_pressure;
    let flow = |conductance, drop| orifice::flow(conductance, drop, transition);
    Edges {
        supply_to_a: flow(conductances.supply_to_a, supply.pressure - pressure_a),
        a_to_tank: flow(conductances.a_to_tank, pressure_a - supply.tank_pressure),
        supply_to_b: flow(conductances.supply_to_b, supply.pressure - pressure_b),
        b_to_tank: flow(conductances.b_to_tank, pressure_b - supply.tank_pressure),
    }
}

/// Flows into both chambers at spool position U_Csp in V and chamber pressures in Pa, m3/s.
///
/// ```text
/// q_A = q_v3 - q_v4        q_B = q_v5 - q_v6                           thesis (4.10), (4.11)
/// ```
///
/// The thesis counts q_vB out of chamber B; here both are positive into their chamber.
///
/// # Example
/// For equal edges at null and half the supply pressure, the leakage into a chamber equals that out
/// of it:
/// ```
/// use phea_hydraulics::reference_rig::valve;
/// use phea_hydraulics::servovalve::{Edges, Servovalve, Supply, chamber_flows};
/// let valve = Servovalve {
///     flow_coefficients: Edges::equal(2.97e-7), leakage_coefficients: Edges::equal(2.48e-9), ..valve()
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
    let edges = edge_flows(valve, supply, &edge_conductances(valve, spool), pressure_a, pressure_b);
    ChamberFlows { into_a: edges.supply_to_a - edges.a_to_tank, into_b: edges.supply_to_b - edges.b_to_tank }
}

/// Control flow q_vC of a valve with equal edges on a symmetric cylinder, positive for U > 0, m3/s.
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
