//! Equilibrium of a yielding supply with the valve and the chambers.

use phea_dynamics::scalar::Scalar;

use super::{Balance, Settled, Steady};
use crate::power_unit::PumpLimited;
use crate::servovalve::{Supply, edge_conductances, edge_flows, tare_flow};

/// Supply, valve and both chambers in equilibrium. Units: Pa, m3/s, 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SettledSupply<S = f64> {
    /// Supply and tank pressures.
    pub supply: Supply<S>,
    /// Command and chamber pressures.
    pub settled: Settled<S>,
    /// Flow of the valve from the supply, including its tare flow.
    pub taken: S,
}

/// Newton steps without and with leakage, with the slope of a flow proportional to the root of the
/// pressure; leakage is proportional to the pressure itself.
const ROUNDS: [usize; 2] = [6, 9];

impl<S: Scalar> Balance<S> {
    /// Equilibrium of a limited pump; this balance has the pressure that the pump holds when idle.
    ///
    /// ```text
    /// p_S = p_idle - dp_o q_S(p_S)/q_pump         down to p_idle - dp_o, at which the relief valve is shut
    /// ```
    ///
    /// If the valve draws more than the pump delivers, the result is the pressure at which the
    /// relief valve closes: the rest of the flow comes from the volume and the accumulator, so that
    /// this is not an equilibrium, and the pressure falls.
    ///
    /// # Example
    /// At null a pump of 10 L/min supplies the leakage and the tare flow, 0.92 L/min in all:
    /// ```
    /// # use phea_hydraulics::{reference_rig::{components, hose_line}, stiffness::StiffnessModel};
    /// use phea_hydraulics::machine::PumpLimited;
    /// use phea_hydraulics::operating_point::{Balance, Steady};
    /// let balance = Balance::at(&components(hose_line(), StiffnessModel::Uniform), 0.25);
    /// let unit = PumpLimited {
    ///     pump_flow: 1.67e-4, relief_override: 5e5, volume: 1e-3, effective_bulk_modulus: 1e9, accumulator: None,
    /// };
    /// let found = balance.settled_supply(&unit, Steady::Command(0.0));
    /// assert!((found.supply.pressure - (70e5 - 5e5 * found.taken / 1.67e-4)).abs() < 1e-3);
    /// assert!((found.taken * 6e4 - 0.92).abs() < 0.01);
    /// ```
    pub fn settled_supply(&self, unit: &PumpLimited<S>, steady: Steady<S>) -> SettledSupply<S> {
        let mut pressure = self.supply.pressure;
        let mut found = self.taking(pressure, steady);
        for _ in 0..ROUNDS[usize::from(self.leaks())] {
            let falls = unit.relief_override * (found.taken / unit.pump_flow).minimum(S::from(1.0));
            let slope = falls / (S::from(2.0) * (pressure - self.supply.tank_pressure));
            let slope = S::select(found.taken.less_than(unit.pump_flow), slope, S::from(0.0));
            let next = pressure + (self.supply.pressure - falls - pressure) / (S::from(1.0) + slope);
            pressure = self.within_relief(next, unit, steady);
            found = self.taking(pressure, steady);
        }
        found
    }

    /// Supply pressure limited to the range of the solution: not below the pressure at which the
    /// relief valve is shut, and at standstill, without return flow, not above the pressure held
    /// when idle. This does not widen its enclosure over a box of parameters.
    fn within_relief(&self, pressure: S, unit: &PumpLimited<S>, steady: Steady<S>) -> S {
        let idle = self.supply.pressure;
        let not_below = pressure.maximum(idle - unit.relief_override);
        let velocity = match steady {
            Steady::Command(_) => S::from(0.0),
            Steady::Moving { velocity, .. } => velocity,
            Steady::Matched(..) => return not_below,
        };
        let still = velocity.abs().less_than(S::from(f64::MIN_POSITIVE));
        S::select(still, not_below.minimum(idle), not_below)
    }

    fn taking(&self, pressure: S, steady: Steady<S>) -> SettledSupply<S> {
        let supply = Supply { pressure, ..self.supply };
        let settled = Balance { supply, ..*self }.settle(steady);
        let [pressure_a, pressure_b] = settled.pressures;
        let conductances = edge_conductances(&self.valve, settled.command);
        let edges = edge_flows(&self.valve, &supply, &conductances, pressure_a, pressure_b);
        let taken = edges.supply_to_a + edges.supply_to_b + tare_flow(&self.valve, &supply);
        SettledSupply { supply, settled, taken }
    }
}
