//! Balance of an operating point over any scalar: a recorded balance is valid over a whole box of
//! parameters.
//!
//! A `Scalar` never branches on a value, so nothing here stops early. Closed forms of plain square
//! roots bracket the unknown, halvings of the bracket approach it from any start, and a fixed
//! number of Newton steps on the regularised equations of [`crate::servovalve`] completes the
//! solution; [`Balance::error`] measures the residual.

use phea_dynamics::scalar::Scalar;

use super::{Balance, SteadyLoad};
use crate::servovalve::{
    ChamberCoefficients, ChamberFlows, SpoolDirection, chamber_coefficients, chamber_flows, edge_conductances,
};

/// Condition of an operating point, over any scalar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Steady<S = f64> {
    /// Standstill at this spool command in V.
    Command(S),
    /// Steady motion at a velocity in m/s under a load; the command that holds it is found. Zero
    /// velocity is standstill.
    Moving {
        /// Velocity v, m/s.
        velocity: S,
        /// Load that the pressures hold.
        load: SteadyLoad<S>,
    },
    /// Matched condition as in [`super::Condition::Matched`].
    Matched(S, S),
}

/// Equilibrium of the valve and both chambers. Units: V, Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settled<S = f64> {
    /// Spool position U_Csp.
    pub command: S,
    /// Chamber pressures p_A and p_B.
    pub pressures: [S; 2],
}

/// Halvings of the spool's travel: to 4e-6 of it, whereas the leakage of the edges falls over a
/// hundredth of the travel.
const HALVINGS_OF_TRAVEL: usize = 18;
/// Number of halvings for the remaining load pressure with a flow from chamber to chamber, to less
/// than the transition pressure of an orifice: with an orifice, and for leakage to the tank.
const HALVINGS_OF_LEAKAGE: usize = 12;
const HALVINGS_OF_ORIFICE: usize = 20;
/// Number of updates of the load pressure for unequal areas.
const ROUNDS: usize = 3;
/// Newton steps without and with leakage.
const STEPS: [usize; 2] = [5, 9];
/// Newton steps from a start close to the solution: each squares its relative error.
const STEPS_FROM_START: usize = 2;
/// Fraction of the nominal voltage within which a spool counts as at null: closer than rounding can
/// resolve.
pub(super) const AT_NULL: f64 = 1e-12;

/// Flow into each side of the piston, and the relation between the pressures.
#[derive(Clone, Copy)]
struct PressureHold<S> {
    velocity: S,
    /// Weights of the required value w_A p_A - w_B p_B.
    weights: [S; 2],
    wanted: S,
}

impl<S: Scalar> Balance<S> {
    /// Equilibrium of the valve and the chambers.
    ///
    /// # Example
    /// The pressures of a recorded supply equal those found for a number:
    /// ```
    /// use phea_dynamics::expression::Expression;
    /// use phea_dynamics::scalar::Parameters;
    /// use phea_hydraulics::operating_point::{Balance, SteadyLoad, Steady};
    /// use phea_hydraulics::reference_rig::{USEFUL_AREA, valve};
    /// use phea_hydraulics::servovalve::Supply;
    /// let recorded = Expression::record(&["pressure", "force"], |p| {
    ///     let supply = Supply { pressure: p[0], tank_pressure: 0.0.into() };
    ///     let balance = Balance { valve: valve().convert(&mut Into::into), supply, areas: [USEFUL_AREA.into(); 2], across: None, outward: None };
    ///     let settled = balance.settle(Steady::Moving { velocity: 0.0.into(), load: SteadyLoad::Force(p[1]) });
    ///     vec![settled.command, settled.pressures[0], settled.pressures[1]]
    /// });
    /// let [command, pressure_a, pressure_b] = recorded.evaluate(&[80e5, 3e3])[..] else { panic!("three results") };
    /// assert!(((pressure_a - pressure_b) * USEFUL_AREA - 3e3_f64).abs() < 1e-6 && command.abs() < 0.1);
    /// ```
    pub fn settle(&self, steady: Steady<S>) -> Settled<S> {
        match steady {
            Steady::Command(command) => {
                let halvings = if self.has_orifice() { HALVINGS_OF_ORIFICE } else { HALVINGS_OF_LEAKAGE };
                Settled { command, pressures: self.settle_at(command, S::from(0.0), halvings) }
            }
            Steady::Moving { velocity, load } => self.settle_moving(velocity, load),
            Steady::Matched(command, load_pressure) => {
                let mean = self.supply.pressure + self.supply.tank_pressure;
                let half = S::from(0.5);
                Settled { command, pressures: [half * (mean + load_pressure), half * (mean - load_pressure)] }
            }
        }
    }

    /// Equilibrium of the valve and the chambers, by Newton steps from a start close to it: smooth
    /// in every parameter and in the start, whereas [`Balance::settle`] halves and selects.
    ///
    /// # Example
    /// From a start one volt and ten bar away, the second step has the digits of the solution:
    /// ```
    /// use phea_hydraulics::operating_point::{Balance, Settled, SteadyLoad, Steady};
    /// use phea_hydraulics::reference_rig::{USEFUL_AREA, valve};
    /// use phea_hydraulics::servovalve::Supply;
    /// let supply = Supply { pressure: 70e5, tank_pressure: 0.0 };
    /// let balance = Balance { valve: valve(), supply, areas: [USEFUL_AREA; 2], across: None, outward: None };
    /// let steady = Steady::Moving { velocity: 0.05, load: SteadyLoad::Force(2e3) };
    /// let found = balance.settle(steady);
    /// let start = Settled { command: found.command + 0.01, pressures: found.pressures.map(|pressure| pressure + 1e4) };
    /// assert!(balance.error(steady, &start) > 1e-3 && balance.error(steady, &balance.settle_from(steady, start)) < 1e-9);
    /// ```
    pub fn settle_from(&self, steady: Steady<S>, start: Settled<S>) -> Settled<S> {
        let Settled { mut command, mut pressures } = start;
        match steady {
            Steady::Command(_) => {
                for _ in 0..STEPS_FROM_START {
                    let [step_a, step_b] = self.step_at(command, S::from(0.0), pressures);
                    pressures = [pressures[0] + step_a, pressures[1] + step_b];
                }
            }
            Steady::Moving { velocity, load } => {
                let hold = self.hold(velocity, load);
                for _ in 0..STEPS_FROM_START {
                    let [step, step_a] = self.step_moving(&hold, command, pressures[0]);
                    (command, pressures[0]) = (command + step, pressures[0] + step_a);
                }
                pressures[1] = hold.other(pressures[0]);
            }
            Steady::Matched(..) => return self.settle(steady),
        }
        Settled { command, pressures }
    }

    /// Newton steps after the initial estimate.
    fn steps(&self) -> usize {
        STEPS[usize::from(self.leaks())]
    }

    /// True if there is a flow from chamber to chamber or to the tank.
    pub(super) fn leaks(&self) -> bool {
        self.across.is_some() || self.outward.is_some()
    }

    fn has_orifice(&self) -> bool {
        self.across.is_some_and(|across| across.orifice.is_some())
    }

    /// Pressures at a spool position in V and a velocity in m/s.
    pub(super) fn settle_at(&self, command: S, velocity: S, halvings: usize) -> [S; 2] {
        let conductances = self.conductances(command);
        let at = |load_pressure: S| self.near(&conductances, velocity, load_pressure);
        let still = at(S::from(0.0));
        let mut pressures = match self.across {
            None => still,
            Some(_) => {
                // the flow leaves a fraction of the load pressure: p_A falls with it and p_B rises
                let [a, b] = still;
                let whole = a - b;
                let falls = |fraction: S| {
                    let [a, b] = at(fraction * whole);
                    (a - b - fraction * whole) * whole
                };
                let left = halved([S::from(0.0), S::from(1.0)], halvings, falls) * whole;
                let ([a, b], half) = (at(left), S::from(0.5));
                match self.has_orifice() {
                    false => [a, b],
                    // its flow at zero drop amplifies the error of the difference
                    true => [half * (a + b + left), half * (a + b - left)],
                }
            }
        };
        for _ in 0..self.steps() {
            let [step_a, step_b] = self.step_at(command, velocity, pressures);
            pressures = [pressures[0] + step_a, pressures[1] + step_b];
        }
        pressures.map(|pressure| self.at_rest(velocity, pressure))
    }

    /// Pressure, limited at standstill to the range between tank and supply, in which every edge
    /// and leakage holds it: so its enclosure over a box of parameters is no wider.
    fn at_rest(&self, velocity: S, pressure: S) -> S {
        let still = velocity.abs().less_than(S::from(f64::MIN_POSITIVE));
        let bounded = pressure.maximum(self.supply.tank_pressure).minimum(self.supply.pressure);
        S::select(still, bounded, pressure)
    }

    fn settle_moving(&self, velocity: S, load: SteadyLoad<S>) -> Settled<S> {
        let hold = self.hold(velocity, load);
        let one = S::from(1.0);
        let [area_a, area_b] = self.areas;
        let (mut load_pressure, rounds) = match (load, self.across) {
            (SteadyLoad::Force(force), Some(_)) => (force * S::from(2.0) / (area_a + area_b), ROUNDS),
            (SteadyLoad::Force(_), None) => (S::from(0.0), 1),
            (SteadyLoad::Pressure(pressure), _) => (pressure, 1),
        };
        let full = self.valve.nominal_voltage;
        let [weight_a, weight_b] = hold.weights;
        let (mut command, mut pressure_a) = (S::from(0.0), S::from(0.0));
        for _ in 0..rounds {
            let at = |relative: S| self.near(&self.conductances(relative * full), velocity, load_pressure);
            let shortfall = |relative: S| {
                let [a, b] = at(relative);
                hold.wanted - (weight_a * a - weight_b * b)
            };
            let relative = halved([-one, one], HALVINGS_OF_TRAVEL, shortfall);
            let [a, b] = at(relative);
            (command, pressure_a, load_pressure) = (relative * full, a, a - b);
        }
        for _ in 0..self.steps() {
            let [step, step_a] = self.step_moving(&hold, command, pressure_a);
            (command, pressure_a) = (command + step, pressure_a + step_a);
        }
        let at_null = command.abs().less_than(full.times(AT_NULL));
        Settled {
            command: S::select(at_null, S::from(0.0), command),
            pressures: [pressure_a, hold.other(pressure_a)].map(|pressure| self.at_rest(velocity, pressure)),
        }
    }

    fn hold(&self, velocity: S, load: SteadyLoad<S>) -> PressureHold<S> {
        match load {
            SteadyLoad::Force(wanted) => PressureHold { velocity, weights: self.areas, wanted },
            SteadyLoad::Pressure(wanted) => PressureHold { velocity, weights: [S::from(1.0); 2], wanted },
        }
    }

    /// Conductances of the edges from supply and to tank, for each chamber.
    fn conductances(&self, command: S) -> [[S; 2]; 2] {
        let edges = edge_conductances(&self.valve, command);
        [[edges.supply_to_a, edges.a_to_tank], [edges.supply_to_b, edges.b_to_tank]]
    }

    /// Both pressures by plain square roots, with the flow from chamber to chamber at a stated load
    /// pressure.
    fn near(&self, [edges_a, edges_b]: &[[S; 2]; 2], velocity: S, load_pressure: S) -> [S; 2] {
        let across = self.across.map_or(S::from(0.0), |across| across.flow(load_pressure));
        let [area_a, area_b] = self.areas;
        [
            self.leaking(0, edges_a, area_a * velocity + across),
            self.leaking(1, edges_b, -area_b * velocity - across),
        ]
    }

    /// Pressure as in [`Balance::between`] with the flow to the tank at this pressure, found by
    /// bisection: the greater that flow, the lower the pressure.
    fn leaking(&self, side: usize, edges: &[S; 2], flow: S) -> S {
        let Some(outward) = &self.outward else { return self.between(edges, flow) };
        let tank = self.supply.tank_pressure;
        let drop = self.supply.pressure - tank;
        let [least, width] = outward.range(side, self.between(edges, flow) - tank, drop, flow);
        let low = tank + least;
        let at = |fraction: S| self.between(edges, flow + self.leaving(side, low + fraction * width));
        let falls = |fraction: S| (at(fraction) - low) / width - fraction;
        low + halved([S::from(0.0), S::from(1.0)], HALVINGS_OF_ORIFICE, falls) * width
    }

    /// Pressure between an edge from supply and one to tank, of conductances a and b, that gives
    /// the flow Q into the chamber.
    ///
    /// ```text
    /// a s(p_S - p) - b s(p - p_T) = Q,      s(d) = sign(d) sqrt|d|,      D = p_S - p_T
    /// sqrt(p_S - p) = (a Q + b sqrt((a^2 + b^2) D - Q^2))/(a^2 + b^2)                 between tank and supply
    /// sqrt(p_S - p) = (Q^2 + b^2 D)/(a Q + b sqrt(Q^2 + (b^2 - a^2) D))               below tank, Q > a sqrt(D)
    /// sqrt(p - p_T) = (Q^2 + a^2 D)/(-b Q + a sqrt(Q^2 + (a^2 - b^2) D))              above supply, Q < -b sqrt(D)
    /// ```
    fn between(&self, &[from_supply, to_tank]: &[S; 2], flow: S) -> S {
        let drop = self.supply.pressure - self.supply.tank_pressure;
        let root = drop.sqrt();
        let [supply, tank, square] = [from_supply, to_tank, flow].map(S::squared);
        let (sum, difference) = (supply + tank, supply - tank);
        let within = (from_supply * flow + to_tank * (sum * drop - square).sqrt()) / sum;
        let below =
            (square + tank * drop) / (from_supply * flow + to_tank * (square - difference * drop).sqrt());
        let above =
            (square + supply * drop) / (from_supply * (square + difference * drop).sqrt() - to_tank * flow);
        let is_below = (from_supply * root).less_than(flow);
        let is_above = flow.less_than(-to_tank * root);
        let not_above = self.supply.pressure - S::select(is_below, below, within).squared();
        S::select(is_above, self.supply.tank_pressure + above.squared(), not_above)
    }

    /// Surplus flow into each chamber, after the piston and the flow from chamber to chamber, and
    /// the slope of the latter.
    fn surplus(&self, command: S, velocity: S, [pressure_a, pressure_b]: [S; 2]) -> ([S; 2], S) {
        let ChamberFlows { into_a, into_b } =
            chamber_flows(&self.valve, &self.supply, command, pressure_a, pressure_b);
        let (none, drop) = (S::from(0.0), pressure_a - pressure_b);
        let (across, conductance) =
            self.across.map_or((none, none), |across| (across.flow(drop), across.slope(drop)));
        let [area_a, area_b] = self.areas;
        let [out_of_a, out_of_b] = [self.leaving(0, pressure_a), self.leaving(1, pressure_b)];
        (
            [into_a - area_a * velocity - across - out_of_a, into_b + area_b * velocity + across - out_of_b],
            conductance,
        )
    }

    fn slopes(&self, command: S, pressures: [S; 2]) -> ChamberCoefficients<S> {
        let [pressure_a, pressure_b] = pressures;
        let outward = self.outward.map(|outward| outward.slopes(pressures, self.supply.tank_pressure));
        chamber_coefficients(&self.valve, &self.supply, command, pressure_a, pressure_b, SpoolDirection::Mean)
            .leaking(outward)
    }

    /// Newton step of both pressures at a fixed spool position.
    pub(super) fn step_at(&self, command: S, velocity: S, pressures: [S; 2]) -> [S; 2] {
        let ([surplus_a, surplus_b], across) = self.surplus(command, velocity, pressures);
        let ChamberCoefficients { flow_pressure_a: a, flow_pressure_b: b, .. } =
            self.slopes(command, pressures);
        let determinant = a * b + across * (a + b);
        [
            ((b + across) * surplus_a + across * surplus_b) / determinant,
            (across * surplus_a + (a + across) * surplus_b) / determinant,
        ]
    }

    /// Newton step of the spool and of p_A, with p_B tied to p_A by the load.
    fn step_moving(&self, hold: &PressureHold<S>, command: S, pressure_a: S) -> [S; 2] {
        let pressures = [pressure_a, hold.other(pressure_a)];
        let ([surplus_a, surplus_b], across) = self.surplus(command, hold.velocity, pressures);
        let slopes = self.slopes(command, pressures);
        let bound = hold.weights[0] / hold.weights[1];
        let a_by_pressure = across * bound - across - slopes.flow_pressure_a;
        let b_by_pressure = across - (slopes.flow_pressure_b + across) * bound;
        let determinant = slopes.flow_gain_a * b_by_pressure + slopes.flow_gain_b * a_by_pressure;
        [
            (surplus_b * a_by_pressure - surplus_a * b_by_pressure) / determinant,
            -(slopes.flow_gain_a * surplus_b + slopes.flow_gain_b * surplus_a) / determinant,
        ]
    }
}

impl Balance {
    /// Error of a settled point: one more Newton step, relative to the nominal voltage and to the
    /// supply's drop; NaN if there is no balance. If the balance is unique, a small step means a
    /// small error, see [`Balance::is_unique`].
    pub fn error(&self, steady: Steady, settled: &Settled) -> f64 {
        let drop = self.supply.pressure - self.supply.tank_pressure;
        let steps = match steady {
            Steady::Matched(..) => return 0.0,
            Steady::Command(command) => {
                self.step_at(command, 0.0, settled.pressures).map(|step| step.abs() / drop)
            }
            Steady::Moving { velocity, load } => {
                let hold = self.hold(velocity, load);
                let [step, step_a] = self.step_moving(&hold, settled.command, settled.pressures[0]);
                [step.abs() / self.valve.nominal_voltage, step_a.abs() / drop]
            }
        };
        steps[0] + steps[1]
    }
}

impl Balance {
    /// True if the pressures are unique for any values: this is so without a flow from chamber to
    /// chamber, with equal areas, at a stated command, and under a stated load pressure. Under a
    /// force, such a flow with unequal areas may leave several.
    ///
    /// ```text
    /// dF/dU ~ A_A K_qA K_cB + A_B K_qB K_cA + G (A_A - A_B) (K_qA - K_qB)              may change its sign with large leakage
    /// ```
    pub fn is_unique(&self, steady: Steady) -> bool {
        let by_force = matches!(steady, Steady::Moving { load: SteadyLoad::Force(_), .. });
        !by_force || self.across.is_none() || self.areas[0] == self.areas[1]
    }
}

impl<S: Scalar> PressureHold<S> {
    /// Pressure p_B for this p_A.
    fn other(&self, pressure_a: S) -> S {
        let [weight_a, weight_b] = self.weights;
        (weight_a * pressure_a - self.wanted) / weight_b
    }
}

/// Zero of a falling function between two ends, by bisection with this number of halvings.
fn halved<S: Scalar>([mut low, mut high]: [S; 2], halvings: usize, falls: impl Fn(S) -> S) -> S {
    for _ in 0..halvings {
        let middle = S::from(0.5) * (low + high);
        let later = S::from(0.0).less_than(falls(middle));
        (low, high) = (S::select(later, middle, low), S::select(later, high, middle));
    }
    S::from(0.5) * (low + high)
}
