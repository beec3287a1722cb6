use phea_dynamics::analytic::Analytic;
use phea_dynamics::scalar::Scalar;

use super::chambers::{ChamberPair, ChamberPolynomials, Reading};
use crate::linear::polynomial::{product, scaled, sum};
use crate::operating_point::{Balance, SettledSupply};
use crate::orifice::{regular_root, regular_root_slope};
use crate::power_unit::PumpLimited;
use crate::servovalve::{SpoolDirection, supply_coefficients};

/// Supply whose pressure is a state, for small motions. Units: m3/Pa, m3/(s Pa), m3/(s V).
///
/// ```text
/// (C_S s + G_S) p_S = -q_S,    q_S = K_qS U + s_A (p_S - p_A) + s_B (p_S - p_B)     at the valve's ports
/// q_A = ... + s_A p_S,    q_B = ... + s_B p_S                                       into the chambers
/// G_S = q_pump/dp_o if the relief valve is open, 0 if it is shut; plus the slope of the tare flow
/// ```
///
/// These are [`crate::machine::PowerUnit`] differentiated. If s_A equals s_B and the chambers are
/// equal, both pressures of a symmetric cylinder follow p_S, without effect on the force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct YieldingSupply<S = f64> {
    /// Compliance C_S of the supply line with its accumulator.
    pub compliance: S,
    /// Conductance G_S of relief valve and tare flow.
    pub conductance: S,
    /// Coefficients s_A and s_B: increase of the flow through the edges from the supply with the
    /// supply pressure.
    pub edges: [S; 2],
    /// Gain K_qS: increase of these flows with the spool position.
    pub flow_gain: S,
}

impl<S: Scalar> YieldingSupply<S> {
    /// Supply of a power unit at an equilibrium of supply, valve and chambers; `stated` is the
    /// pressure in Pa that an idle pump holds.
    pub fn new(
        unit: &PumpLimited<S>,
        balance: &Balance<S>,
        stated: S,
        settled: &SettledSupply<S>,
        direction: SpoolDirection<S>,
    ) -> YieldingSupply<S> {
        let (valve, pressure) = (&balance.valve, settled.supply.pressure);
        let opens = stated - unit.relief_override;
        let relief = unit.pump_flow / unit.relief_override;
        let relief = S::select(opens.less_than(pressure), relief, S::from(0.0));
        let drop = pressure - settled.supply.tank_pressure;
        let tare = valve.tare_flow * regular_root_slope(drop, valve.transition_pressure)
            / regular_root(valve.tare_reference_drop, valve.transition_pressure);
        let at = &settled.settled;
        let found = supply_coefficients(valve, &settled.supply, at.command, at.pressures, direction);
        YieldingSupply {
            compliance: unit.compliance(pressure),
            conductance: relief + tare,
            edges: [found.edge_a, found.edge_b],
            flow_gain: found.flow_gain,
        }
    }
}

/// Equations of the pressures: admittances of both chambers and of the supply, and their coupling.
pub(super) struct Coupled<T> {
    /// Own admittances of chamber A, chamber B and the supply: all that is connected to each except
    /// the flow from chamber to chamber.
    pub(super) own: [T; 3],
    /// Factors of the first two, whose product multiplies the result; `None` for one.
    pub(super) passed: Option<[T; 2]>,
    /// Coupling from the supply into each chamber.
    pub(super) edges: [T; 2],
    /// Gains of the spool: flow to chamber A, flow from chamber B, and flow from the supply.
    pub(super) gains: [T; 3],
}

/// Quantity that can be multiplied and added as an admittance.
pub(super) trait Admittance<S>: Sized {
    fn plus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;
    fn by(&self, factor: S) -> Self;
}

impl<S: Scalar> Admittance<S> for Vec<S> {
    fn plus(&self, other: &Self) -> Self {
        sum(self, other)
    }
    fn times(&self, other: &Self) -> Self {
        product(self, other)
    }
    fn by(&self, factor: S) -> Self {
        scaled(factor, self)
    }
}

/// Value at s, or over a set of values of s.
#[derive(Clone, Copy)]
pub(super) struct Over<A>(pub(super) A);

impl<A: Analytic> Admittance<f64> for Over<A> {
    fn plus(&self, other: &Self) -> Self {
        Over(self.0 + other.0)
    }
    fn times(&self, other: &Self) -> Self {
        Over(self.0 * other.0)
    }
    fn by(&self, factor: f64) -> Self {
        Over(self.0.scaled(factor))
    }
}

impl<T> Coupled<T> {
    /// Admittance of both chambers as one.
    fn together<S: Scalar>(&self) -> T
    where
        T: Admittance<S>,
    {
        let [a, b, _] = &self.own;
        match &self.passed {
            None => a.plus(b),
            Some([passed_a, passed_b]) => a.times(passed_b).plus(&b.times(passed_a)),
        }
    }

    /// Polynomials D, N_u and N_v of these pressures by Cramer's rule, the areas in m2.
    ///
    /// ```text
    /// [ a     0   -s_A ] [p_A]   [ K_qA]       [-A_A]
    /// [ 0     b   -s_B ] [p_B] = [-K_qB] U  +  [ A_B] s X,        D = a b c - a s_B^2 - b s_A^2
    /// [-s_A -s_B   c   ] [p_S]   [-K_qS]       [  0 ]
    /// joined: p_A = p_B,   [a + b, -s; -s, c] with s = s_A + s_B,   D = (a + b) c - s^2
    /// ```
    pub(super) fn chambers<S: Scalar>(&self, [area_a, area_b]: [S; 2], reading: &Reading<S>) -> ChamberPair<T>
    where
        T: Admittance<S>,
    {
        let minus = |value: &T| value.by(S::from(-1.0));
        let times = |side: usize, value: T| match &self.passed {
            None => value,
            Some(passed) => passed[side].times(&value),
        };
        let both = |value: T| times(0, times(1, value));
        let [a, b, c] = &self.own;
        let [of_a, of_b] = &self.edges;
        let bc = b.times(c).plus(&minus(&times(1, of_b.times(of_b))));
        let ac = a.times(c).plus(&minus(&times(0, of_a.times(of_a))));
        let ab = both(of_a.times(of_b));
        let (from_a, from_b) = (times(0, b.times(of_a)), times(1, a.times(of_b)));
        let own = a.times(&bc).plus(&minus(&of_a.times(&from_a)));
        let (bc, ac) = (times(0, bc), times(1, ac));
        let [read_a, read_b] = reading.weights;
        let read = |a: &T, b: &T| a.by(read_a).plus(&b.by(-read_b));
        let [by_a, by_b, by_supply] = [read(&bc, &ab), read(&ab, &ac), read(&from_a, &from_b)];
        let [gain_a, gain_b, gain_supply] = &self.gains;
        let taken = by_b.times(gain_b).plus(&by_supply.times(gain_supply));
        let of_both = of_a.plus(of_b);
        let given = gain_a.plus(&minus(gain_b)).times(c).plus(&minus(&of_both.times(gain_supply)));
        let together = self.together::<S>();
        ChamberPair {
            apart: ChamberPolynomials {
                own,
                driven: by_a.times(gain_a).plus(&minus(&taken)),
                displaced: by_a.by(area_a).plus(&by_b.by(-area_b)),
            },
            joined: ChamberPolynomials {
                own: together.times(c).plus(&minus(&both(of_both.times(&of_both)))),
                driven: both(given).by(reading.difference),
                displaced: both(c.by(reading.displaced_difference)),
            },
        }
    }

    /// Determinant det [A K] of areas and gains, expanded by the minors of the equations: it is the
    /// information in the pressures beyond the force, see
    /// [`PressureFeedback`](super::PressureFeedback).
    ///
    /// ```text
    /// c (A_B K_qA - A_A K_qB) - s_B A_A K_qS - s_A A_B K_qS
    /// ```
    pub(super) fn turned<S: Scalar>(&self, [area_a, area_b]: [S; 2]) -> T
    where
        T: Admittance<S>,
    {
        let [gain_a, gain_b, gain_supply] = &self.gains;
        let [of_a, of_b] = &self.edges;
        let across = gain_a.by(area_b).plus(&gain_b.by(-area_a));
        let taken = of_b.by(area_a).plus(&of_a.by(area_b)).times(gain_supply);
        let turned = self.own[2].times(&across).plus(&taken.by(S::from(-1.0)));
        match &self.passed {
            None => turned,
            Some([passed_a, passed_b]) => turned.times(passed_a).times(passed_b),
        }
    }
}
