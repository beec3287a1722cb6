//! Relief and check valves from their tables.

use phea_dynamics::scalar::Scalar;

use super::{DeclaredPortValve, DeclaredPortValves, PortValves, TankValve};
use crate::servovalve::Servovalve;

/// Half width of the transition of a valve that states none, Pa.
pub(super) const TRANSITION_PRESSURE: f64 = 1e4;

/// Override of a check valve that states none, Pa: it passes its flow at a drop of 1 bar.
const CHECK_OVERRIDE: f64 = 1e5;

/// Pressure drop over each of the two edges of a servovalve at which its flow is rated, Pa: 70 bar
/// over both.
const RATED_EDGE_DROP: f64 = 35e5;

impl<S: Scalar> DeclaredPortValves<S> {
    /// Valves of both chambers next to this servovalve; `None` for a chamber without.
    pub fn components(&self, servovalve: &Servovalve<S>) -> [Option<PortValves<S>>; 2] {
        let [opened, _] = servovalve.opening.full();
        let rated = servovalve.flow_coefficients.supply_to_a * opened * S::from(RATED_EDGE_DROP.sqrt());
        [&self.a, &self.b].map(|valves| valves.component(rated))
    }
}

impl<S: Scalar> DeclaredPortValve<S> {
    /// Relief and check valve of one chamber; `None` without a valve. A flow that is not stated is
    /// `rated`, the flow of the open servovalve at 70 bar, in m3/s.
    ///
    /// # Example
    /// The check valve has the flow of the relief valve unless it states its own:
    /// ```
    /// use phea_hydraulics::port_valves::DeclaredPortValve;
    /// let declared = DeclaredPortValve {
    ///     cracking_pressure: Some(150e5), pressure_override: Some(10e5), flow: Some(1e-3),
    ///     check_valve_pressure: Some(0.3e5), ..DeclaredPortValve::default()
    /// };
    /// let valves = declared.component(5e-4).unwrap();
    /// assert_eq!(valves.relief.unwrap().conductance, 1e-9);
    /// assert_eq!(valves.check.unwrap().conductance, 1e-8);
    /// let without_flow = DeclaredPortValve { flow: None, ..declared };
    /// assert_eq!(without_flow.component(5e-4).unwrap().relief.unwrap().conductance, 5e-10);
    /// assert_eq!(DeclaredPortValve::<f64>::default().component(5e-4), None);
    /// ```
    pub fn component(&self, rated: S) -> Option<PortValves<S>> {
        let flow = self.flow.unwrap_or(rated);
        let relief = self.relief().map(|[cracking_pressure, pressure_override]| TankValve {
            cracking_pressure,
            conductance: flow / pressure_override,
        });
        let check = self.has_check().then(|| TankValve {
            cracking_pressure: self.check_valve_pressure.unwrap_or(S::from(0.0)),
            conductance: self.check_valve_flow.unwrap_or(flow)
                / self.check_valve_override.unwrap_or(S::from(CHECK_OVERRIDE)),
        });
        if relief.is_none() && check.is_none() {
            return None;
        }
        let transition_pressure = self.transition_pressure.unwrap_or(S::from(TRANSITION_PRESSURE));
        Some(PortValves { relief, check, transition_pressure })
    }
}
