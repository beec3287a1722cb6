//! Flow from each chamber to the tank that does not pass the servovalve.
//!
//! ```text
//! q_e = G_e (p - p_T) + q_r + q_c                          leakage through the case of a motor, port_valves.rs
//! ```
//!
//! Positive out of the chamber. The equilibrium, the linear models and the machine take this flow
//! from here, so that a part which joins a chamber to the tank is added in this file.

use phea_dynamics::scalar::Scalar;

use crate::cylinder::CASE_LEAKAGE_KEY;
use crate::parameter::{ParameterError, Problems};
use crate::port_valves::PortValves;

/// Everything that passes oil from the chambers to the tank, next to the servovalve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OutwardFlow<S = f64> {
    /// Laminar leakage of each chamber per pressure above tank pressure, m3/(s Pa), as of a motor
    /// through its case; `None` without such leakage.
    pub external_leakage: Option<S>,
    /// Relief and check valves of chambers A and B.
    pub port_valves: [Option<PortValves<S>>; 2],
}

phea_dynamics::parameters! { OutwardFlow { external_leakage, port_valves } }

impl OutwardFlow {
    /// Impossible parameters of these parts, by their paths; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        if let Some(leakage) = self.external_leakage {
            problems.key_as("cylinder.external_leakage", CASE_LEAKAGE_KEY, leakage);
        }
        for (valves, path) in self.port_valves.iter().zip(["port_valves.a", "port_valves.b"]) {
            problems.component(path, valves.map_or(Vec::new(), |valves| valves.problems()));
        }
        problems.into_vec()
    }
}

impl<S: Scalar> OutwardFlow<S> {
    /// These parts, or `None` if nothing passes from a chamber to the tank.
    pub fn if_present(self) -> Option<OutwardFlow<S>> {
        let is_present = self.external_leakage.is_some() || self.port_valves.iter().any(Option::is_some);
        is_present.then_some(self)
    }

    /// Flows out of both chambers at their pressures and that of the tank in Pa, m3/s.
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::outward_flow::OutwardFlow;
    /// let case = OutwardFlow { external_leakage: Some(2e-12), port_valves: [None; 2] };
    /// assert_eq!(case.flows([30e5, 10e5], 10e5), [4e-6, 0.0]);
    /// assert_eq!(case.slopes([30e5, 10e5], 10e5), [2e-12; 2]);
    /// ```
    #[inline(always)]
    pub fn flows(&self, pressures: [S; 2], tank_pressure: S) -> [S; 2] {
        [0, 1].map(|side| self.flow(side, pressures[side] - tank_pressure))
    }

    /// Slopes of these flows over the pressure of their chamber, m3/(s Pa).
    pub fn slopes(&self, pressures: [S; 2], tank_pressure: S) -> [S; 2] {
        [0, 1].map(|side| self.slope(side, pressures[side] - tank_pressure))
    }

    /// Flow out of chamber A (0) or B (1) at a pressure above that of the tank in Pa, m3/s.
    #[inline(always)]
    pub(crate) fn flow(&self, side: usize, above_tank: S) -> S {
        let leakage = self.external_leakage.map(|conductance| conductance * above_tank);
        let valves = self.port_valves[side].map(|valves| valves.flow(above_tank));
        match (leakage, valves) {
            (Some(leakage), Some(valves)) => leakage + valves,
            (one, other) => one.or(other).unwrap_or(S::from(0.0)),
        }
    }

    fn slope(&self, side: usize, above_tank: S) -> S {
        let valves = self.port_valves[side].map(|valves| valves.slope(above_tank));
        match (self.external_leakage, valves) {
            (Some(leakage), Some(valves)) => leakage + valves,
            (one, other) => one.or(other).unwrap_or(S::from(0.0)),
        }
    }

    /// Flows out of both chambers through their relief and check valves, at pressures in Pa, m3/s.
    pub(crate) fn through_port_valves(&self, pressures: [S; 2], tank_pressure: S) -> [S; 2] {
        [0, 1].map(|side| {
            let valves = self.port_valves[side];
            valves.map_or(S::from(0.0), |valves| valves.flow(pressures[side] - tank_pressure))
        })
    }

    /// Least pressure of chamber A (0) or B (1) above that of the tank, and the width of its range,
    /// in Pa: without this flow the pressure is `free`, the supply is `drop` above the tank, and
    /// the piston and the other chamber take `taken` in m3/s.
    pub(crate) fn range(&self, side: usize, free: S, drop: S, taken: S) -> [S; 2] {
        let Some(valves) = &self.port_valves[side] else { return [S::from(0.0), drop] };
        let [least, greatest] = valves.range(free, drop, taken);
        [least, greatest - least]
    }
}
