use phea_dynamics::scalar::Scalar;

use super::flow::left;
use super::{Edges, LeakageModel, Openings, Servovalve, Supply, edge_conductances};
use crate::orifice::{regular_root, regular_root_slope};

/// Side of null from which slopes are taken if the spool is exactly at null, since different edges
/// open on each side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpoolDirection<S = f64> {
    /// Extending, U > 0: supply to A, B to tank.
    Extending,
    /// Retracting, U < 0: supply to B, A to tank.
    Retracting,
    /// Mean of both, for a small symmetric motion about null.
    Mean,
    /// Slopes of chords across null, from -1, retracting, to 1, extending.
    ///
    /// ```text
    /// (q(b) - q(a))/(b - a) = (1 + n)/2 q'(0+) + (1 - n)/2 q'(0-),      n = (b + a)/(b - a),      a <= 0 <= b, both small
    /// ```
    Between(S),
}

impl<S: Scalar> SpoolDirection<S> {
    /// Number n of [`SpoolDirection::Between`].
    pub(super) fn side(self) -> S {
        match self {
            SpoolDirection::Extending => S::from(1.0),
            SpoolDirection::Retracting => S::from(-1.0),
            SpoolDirection::Mean => S::from(0.0),
            SpoolDirection::Between(side) => side,
        }
    }
}

/// Derivatives of the flows of each chamber. Units: m3/(s V), m3/(s Pa). All positive in ordinary
/// operation.
///
/// ```text
/// dq_A = K_qA dU - K_cA dp_A        dq_B = -K_qB dU - K_cB dp_B        thesis (4.19), for each chamber
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChamberCoefficients<S = f64> {
    /// Flow gain K_qA = dq_A/dU.
    pub flow_gain_a: S,
    /// Flow-pressure coefficient K_cA = -dq_A/dp_A.
    pub flow_pressure_a: S,
    /// Flow gain K_qB = -dq_B/dU.
    pub flow_gain_b: S,
    /// Flow-pressure coefficient K_cB = -dq_B/dp_B.
    pub flow_pressure_b: S,
}

impl<S: Scalar> ChamberCoefficients<S> {
    /// Coefficients of chambers that also leak to the tank, with these slopes in m3/(s Pa): the net
    /// flow falls with the pressure like that of the valve.
    #[must_use]
    pub fn leaking(self, outward: Option<[S; 2]>) -> ChamberCoefficients<S> {
        let Some([slope_a, slope_b]) = outward else { return self };
        ChamberCoefficients {
            flow_pressure_a: self.flow_pressure_a + slope_a,
            flow_pressure_b: self.flow_pressure_b + slope_b,
            ..self
        }
    }
}

/// Derivatives of [`super::chamber_flows`] at any spool position and chamber pressures, for any
/// edges.
///
/// ```text
/// K_qA =  G_3' root(p_S - p_A) - G_4' root(p_A - p_T)        K_cA = G_3 root'(p_S - p_A) + G_4 root'(p_A - p_T)
/// K_qB = -G_5' root(p_S - p_B) + G_6' root(p_B - p_T)        K_cB = G_5 root'(p_S - p_B) + G_6 root'(p_B - p_T)
/// ```
///
/// with primes for d/dU and d/dp; sech' = -(lambda/U_n) sech tanh is the contribution of the
/// leakage, which thesis (4.21) omits. `direction` matters only at U = 0.
pub fn chamber_coefficients<S: Scalar>(
    valve: &Servovalve<S>,
    supply: &Supply<S>,
    spool: S,
    pressure_a: S,
    pressure_b: S,
    direction: SpoolDirection<S>,
) -> ChamberCoefficients<S> {
    let conductances = edge_conductances(valve, spool);
    let slopes = conductance_slopes(valve, spool, direction);
    let root = |drop| regular_root(drop, valve.transition_pressure);
    let slope = |drop| regular_root_slope(drop, valve.transition_pressure);
    let [from_supply_a, to_tank_a] = [supply.pressure - pressure_a, pressure_a - supply.tank_pressure];
    let [from_supply_b, to_tank_b] = [supply.pressure - pressure_b, pressure_b - supply.tank_pressure];
    ChamberCoefficients {
        flow_gain_a: slopes.supply_to_a * root(from_supply_a) - slopes.a_to_tank * root(to_tank_a),
        flow_pressure_a: conductances.supply_to_a * slope(from_supply_a)
            + conductances.a_to_tank * slope(to_tank_a),
        flow_gain_b: slopes.b_to_tank * root(to_tank_b) - slopes.supply_to_b * root(from_supply_b),
        flow_pressure_b: conductances.supply_to_b * slope(from_supply_b)
            + conductances.b_to_tank * slope(to_tank_b),
    }
}

/// Derivatives of the flow through the edges from the supply. Units: m3/(s Pa), m3/(s V).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupplyCoefficients<S = f64> {
    /// Coefficient s_A = dq_A/dp_S = -dq_S/dp_A, of the edge from the supply to chamber A.
    pub edge_a: S,
    /// Coefficient s_B, likewise to chamber B.
    pub edge_b: S,
    /// Gain K_qS = dq_S/dU, of both edges.
    pub flow_gain: S,
}

/// Derivatives of the flow from the supply at any spool position and chamber pressures p_A and p_B.
///
/// ```text
/// s_A  = G_3 root'(p_S - p_A)        s_B = G_5 root'(p_S - p_B)
/// K_qS = G_3' root(p_S - p_A) + G_5' root(p_S - p_B)
/// ```
///
/// s_A is the contribution of the supply edge to K_cA.
pub(crate) fn supply_coefficients<S: Scalar>(
    valve: &Servovalve<S>,
    supply: &Supply<S>,
    spool: S,
    pressures: [S; 2],
    direction: SpoolDirection<S>,
) -> SupplyCoefficients<S> {
    let conductances = edge_conductances(valve, spool);
    let slopes = conductance_slopes(valve, spool, direction);
    let [drop_a, drop_b] = pressures.map(|pressure| supply.pressure - pressure);
    let root = |drop| regular_root(drop, valve.transition_pressure);
    let slope = |drop| regular_root_slope(drop, valve.transition_pressure);
    SupplyCoefficients {
        edge_a: conductances.supply_to_a * slope(drop_a),
        edge_b: conductances.supply_to_b * slope(drop_b),
        flow_gain: slopes.supply_to_a * root(drop_a) + slopes.supply_to_b * root(drop_b),
    }
}

/// Slopes dG_i/dU of [`edge_conductances`], m3/(s Pa^0.5 V).
///
/// ```text
/// G_i' = K_vi u+-' + K_vini sech'                                              each edge
/// G_i' = K_vi u+-' + k (O^3 sech' - k^2 sech^3 O')/(O^2 - k^2 sech^2)^(3/2)      one curve
///        with O = K_vj u+- + K_vinj sech of the other edge at the same port
/// ```
fn conductance_slopes<S: Scalar>(valve: &Servovalve<S>, spool: S, direction: SpoolDirection<S>) -> Edges<S> {
    let (flow, leak) = (&valve.flow_coefficients, &valve.leakage_coefficients);
    let Openings { forward, backward, leakage } = Openings::at(valve, spool);
    let Openings { forward: forward_slope, backward: backward_slope, leakage: leakage_slope } =
        Openings::slopes(valve, spool, direction);
    match valve.leakage_model {
        LeakageModel::EachEdge => Edges {
            supply_to_a: flow.supply_to_a * forward_slope + leak.supply_to_a * leakage_slope.supply_to_a,
            a_to_tank: flow.a_to_tank * backward_slope + leak.a_to_tank * leakage_slope.a_to_tank,
            supply_to_b: flow.supply_to_b * backward_slope + leak.supply_to_b * leakage_slope.supply_to_b,
            b_to_tank: flow.b_to_tank * forward_slope + leak.b_to_tank * leakage_slope.b_to_tank,
        },
        LeakageModel::OneCurve => {
            let forward = [forward, forward_slope];
            let backward = [backward, backward_slope];
            let leakage = [left(leakage.supply_to_a), leakage_slope.supply_to_a];
            let opened = |coefficient: S, by: [S; 2]| by.map(|fraction| coefficient * fraction);
            let [open_a, shut_a] = [opened(flow.supply_to_a, forward), opened(flow.a_to_tank, backward)];
            let [open_b, shut_b] = [opened(flow.supply_to_b, backward), opened(flow.b_to_tank, forward)];
            Edges {
                supply_to_a: open_a[1] + closing_slope(shut_a, [leak.a_to_tank, leak.supply_to_a], leakage),
                a_to_tank: shut_a[1] + closing_slope(open_a, [leak.supply_to_a, leak.a_to_tank], leakage),
                supply_to_b: open_b[1] + closing_slope(shut_b, [leak.b_to_tank, leak.supply_to_b], leakage),
                b_to_tank: shut_b[1] + closing_slope(open_b, [leak.supply_to_b, leak.b_to_tank], leakage),
            }
        }
    }
}

/// Slope of the leakage of an edge that closes while its partner opens, in one curve; from the
/// opening of the partner, and the secant, each with its slope.
fn closing_slope<S: Scalar>(
    [opened, opened_slope]: [S; 2],
    [partner, own]: [S; 2],
    [leakage, leakage_slope]: [S; 2],
) -> S {
    let squares = partner.squared() + own.squared();
    let series = partner * own / squares.sqrt();
    let all = opened + partner * leakage;
    let all_slope = opened_slope + partner * leakage_slope;
    let partner_squared = partner.squared();
    let rest = opened * (opened + S::from(2.0) * partner * leakage)
        + partner_squared * partner_squared / squares * leakage.squared();
    let closing =
        all * all.squared() * leakage_slope - series.squared() * leakage * leakage.squared() * all_slope;
    series * closing / (rest * rest.sqrt())
}

/// Flow gain K_qU and flow-pressure coefficient K_c of the control flow. Units: m3/(s V), m3/(s
/// Pa).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControlCoefficients<S = f64> {
    /// Flow gain K_qU = dq_vC/dU.
    pub flow_gain: S,
    /// Flow-pressure coefficient K_c = -dq_vC/dp_L.
    pub flow_pressure_coefficient: S,
}

/// Flow gain and flow-pressure coefficient of the control flow on a symmetric cylinder, at any U
/// and load pressure p_L.
///
/// ```text
/// dq_vC = K_qU dU - K_c dp_L                                                              thesis (4.20)
/// K_qU =  dq_vC/dU   = K_vp/U_n sqrt((p_S - p_T - s p_L)/2) + K_vinp sech' (...)          thesis (4.21), corrected
/// K_c  = -dq_vC/dp_L = (K_vp |u| + K_vinp sech)/sqrt(8 (p_S - p_T - s p_L))
///                      + K_vinp sech/sqrt(8 (p_S - p_T + s p_L))                          thesis (4.22), corrected
/// ```
///
/// with s = sgn U. As in thesis (4.18), p_A and p_B are (p_S + p_T +- p_L)/2, which is the
/// equilibrium of equal edges; the edges may be unequal, the control flow being the mean of both
/// chambers (4.17): K_qU = (K_qA + K_qB)/2 and K_c = (K_cA + K_cB)/4.
///
/// # Example
/// Example: the null coefficient of Table 6.3.
/// ```
/// # use phea_hydraulics::servovalve::*;
/// # let valve = Servovalve {
/// #     flow_coefficients: Edges::equal(2.97e-7), leakage_coefficients: Edges::equal(2.40e-9),
/// #     ..phea_hydraulics::reference_rig::valve()
/// # };
/// let supply = Supply { pressure: 70e5, tank_pressure: 0.0 };
/// let null = control_coefficients(&valve, &supply, 0.0, 0.0, SpoolDirection::Mean);
/// assert!((null.flow_pressure_coefficient - 6.42e-13).abs() < 1e-15);
/// ```
pub fn control_coefficients<S: Scalar>(
    valve: &Servovalve<S>,
    supply: &Supply<S>,
    spool: S,
    load_pressure: S,
    direction: SpoolDirection<S>,
) -> ControlCoefficients<S> {
    let mean = supply.pressure + supply.tank_pressure;
    let half = S::from(0.5);
    let (pressure_a, pressure_b) = (half * (mean + load_pressure), half * (mean - load_pressure));
    let chambers = chamber_coefficients(valve, supply, spool, pressure_a, pressure_b, direction);
    ControlCoefficients {
        flow_gain: half * (chambers.flow_gain_a + chambers.flow_gain_b),
        flow_pressure_coefficient: S::from(0.25) * (chambers.flow_pressure_a + chambers.flow_pressure_b),
    }
}

/// Steady piston speed per volt under a load, without leakage, m/(s V); `None` if the supply cannot
/// move the load.
///
/// ```text
/// extending:  A_A v = K_v3 u sqrt(p_S - p_A),  A_B v = K_v6 u sqrt(p_B - p_T),  A_A p_A - A_B p_B = F
///             v/u = sqrt((A_A p_S - A_B p_T - F) / (A_A^3/K_v3^2 + A_B^3/K_v6^2))
/// retracting: with edges 5 and 4, B and A exchanged and F reversed
/// ```
///
/// Both metering edges carry the piston's flow in series. For a symmetric cylinder A v/U is the
/// flow gain that a no-load flow test finds; it differs from the mean of both chambers' slopes
/// (4.17) when the edges are unequal. Areas A_A, A_B in m2, force on the load in N, positive when
/// the rod pushes. `SpoolDirection::Mean` is the mean of both speeds.
///
/// # Example
/// The edges of Table 5.1 at 70 bar: 6.51e-5 m3/(s V) extending and 4.13e-5 retracting:
/// ```
/// # use phea_hydraulics::servovalve::*;
/// # let valve = phea_hydraulics::reference_rig::valve();
/// let supply = Supply { pressure: 70e5, tank_pressure: 0.0 };
/// let area = 1.58336e-3;
/// let flow_gain = |direction| velocity_gain(&valve, &supply, [area, area], 0.0, direction).map(|v| area * v);
/// assert!((flow_gain(SpoolDirection::Extending).unwrap() - 6.51e-5).abs() < 0.5e-7);
/// assert!((flow_gain(SpoolDirection::Retracting).unwrap() - 4.13e-5).abs() < 0.5e-7);
/// ```
pub fn velocity_gain(
    valve: &Servovalve,
    supply: &Supply,
    areas: [f64; 2],
    load_force: f64,
    direction: SpoolDirection,
) -> Option<f64> {
    let flow = &valve.flow_coefficients;
    let [area_a, area_b] = areas;
    let gain = |driven: f64, other: f64, driving_edge: f64, return_edge: f64, force: f64| {
        let drive = driven * supply.pressure - other * supply.tank_pressure - force;
        let resistance = driven * (driven / driving_edge) * (driven / driving_edge)
            + other * (other / return_edge) * (other / return_edge);
        (drive >= 0.0).then(|| (drive / resistance).sqrt() / valve.nominal_voltage)
    };
    let extending = gain(area_a, area_b, flow.supply_to_a, flow.b_to_tank, load_force);
    let retracting = gain(area_b, area_a, flow.supply_to_b, flow.a_to_tank, -load_force);
    match direction {
        SpoolDirection::Extending => extending,
        SpoolDirection::Retracting => retracting,
        SpoolDirection::Mean => Some((extending? + retracting?) / 2.0),
        SpoolDirection::Between(side) => Some((extending? * (1.0 + side) + retracting? * (1.0 - side)) / 2.0),
    }
}
