//! Test stand of a servovalve: a pump that may deliver less than the valve takes, and a meter with
//! a pressure drop.

use super::{PortCircuit, PortState, Servovalve, Supply, blocked_ports, connected_ports, tare_flow};
use crate::orifice::regular_root;

/// Valve on its test stand, with the piping of its ports in the test. Units: Pa, m3/s, m3/(s
/// Pa^0.5).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TestStand {
    /// The valve.
    pub valve: Servovalve,
    /// Stated supply and tank pressures.
    pub supply: Supply,
    /// Flow of the pump, and the rise of pressure over which its relief valve opens; `None` for a
    /// constant supply.
    pub pump: Option<[f64; 2]>,
    /// Flow of the meter between the ports at a drop of 1 Pa; infinite without a pressure drop.
    pub meter_coefficient: f64,
}

/// Equilibrium of a test stand. Units: Pa, m3/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandState {
    /// Remaining supply pressure.
    pub supply_pressure: f64,
    /// Port pressures and flows.
    pub ports: PortState,
    /// Tare flow of the first stage.
    pub tare_flow: f64,
}

/// Halvings of an interval: a supply of 1000 bar to 0.1 mPa.
const HALVINGS: usize = 40;

impl TestStand {
    /// Equilibrium at a position of the edges in V.
    ///
    /// ```text
    /// q_P = q_v3 + q_v5 + q_tare + q_relief(p_S)        q_relief = q_P (p_S - p_stated + dp_o)/dp_o, not below 0
    /// q_port = K_m root(p_A - p_B)                       in place of p_A = p_B if the meter has a pressure drop
    /// ```
    ///
    /// # Example
    /// The pump of the thesis cannot supply its valve at 30 % of the command:
    /// ```
    /// use phea_hydraulics::reference_rig::valve;
    /// use phea_hydraulics::servovalve::{PortCircuit, Supply, TestStand};
    /// let stand = TestStand {
    ///     valve: valve(), supply: Supply { pressure: 70e5, tank_pressure: 0.0 }, pump: Some([1.6e-4, 5e5]),
    ///     meter_coefficient: f64::INFINITY,
    /// };
    /// let found = stand.settled(PortCircuit::Connected, 3.0);
    /// assert!(found.supply_pressure < 55e5);
    /// assert!((found.ports.supply_flow + found.tare_flow - 1.6e-4).abs() < 1e-9);
    /// ```
    pub fn settled(&self, circuit: PortCircuit, opening: f64) -> StandState {
        let at = |pressure: f64| {
            let supply = Supply { pressure, ..self.supply };
            let ports = self.ports(&supply, circuit, opening);
            let tare_flow = tare_flow(&self.valve, &supply);
            StandState { supply_pressure: pressure, ports, tare_flow }
        };
        let Some([pump_flow, relief_override]) = self.pump else { return at(self.supply.pressure) };
        let surplus = |pressure: f64| {
            let found = at(pressure);
            let relief = (pressure - self.supply.pressure + relief_override).max(0.0) / relief_override;
            pump_flow * (1.0 - relief) - found.ports.supply_flow - found.tare_flow
        };
        at(falling_zero(surplus, [self.supply.tank_pressure, self.supply.pressure]))
    }

    fn ports(&self, supply: &Supply, circuit: PortCircuit, opening: f64) -> PortState {
        if circuit == PortCircuit::Blocked {
            return blocked_ports(&self.valve, supply, opening);
        }
        let at = |load_pressure| connected_ports(&self.valve, supply, opening, load_pressure);
        if self.meter_coefficient.is_infinite() {
            return at(0.0);
        }
        let surplus = |load_pressure: f64| {
            let metered =
                self.meter_coefficient * regular_root(load_pressure, self.valve.transition_pressure);
            at(load_pressure).port_flow - metered
        };
        // the meter never takes the whole pressure: at the ends the valve passes only its leakage
        let whole = 0.999 * (supply.pressure - supply.tank_pressure);
        at(falling_zero(surplus, [-whole, whole]))
    }
}

/// Zero of a falling function between two ends; the nearer end if there is none.
fn falling_zero(function: impl Fn(f64) -> f64, [mut low, mut high]: [f64; 2]) -> f64 {
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(low, high);
        if function(middle) > 0.0 { low = middle } else { high = middle }
    }
    f64::midpoint(low, high)
}
