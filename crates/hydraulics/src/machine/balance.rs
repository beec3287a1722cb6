use nalgebra::{Matrix4, Vector4};
use phea_dynamics::scalar::{Dual, Parameters, Scalar};

use super::equations::constant;
use super::{Machine, MachineState, PowerUnit};
use crate::operating_point::hydraulic_force;

/// Value that an equilibrium holds while the pressures are found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum HeldValue {
    /// Position of the spool.
    Spool,
    /// Force of the pressures on the piston, N.
    Force(f64),
}

/// Scales of surplus flows in m3/s, of the supply pressure in Pa, of the spool in V and of the
/// force in N.
const FLOW_SCALE: f64 = 1e-6;
const PRESSURE_SCALE: f64 = 1e5;
const FORCE_SCALE: f64 = 10.0;

/// Newton steps, and halvings of each.
const STEPS: usize = 60;

/// Unknowns p_A, p_B, p_S and the spool's position.
type Unknowns = Vector4<f64>;

impl Machine {
    /// State with the pressures and the spool position at which the flows balance the motion of the
    /// piston: by damped Newton steps from the given state.
    ///
    /// ```text
    /// q_A(U, p_A + R_A Q_A, p_S) = Q_A = A_A v + q_i        q_B(...) = Q_B = -A_B v - q_i
    /// p_S as stated, or q_pump - q_relief = q_supply        U as given, or A_A p_A - A_B p_B = F
    /// ```
    ///
    /// R is the steady resistance of a line, and the areas are those at a position in m.
    pub(super) fn balanced(
        &self,
        state: &MachineState,
        position: f64,
        held_value: HeldValue,
    ) -> MachineState {
        let areas = self.areas_at(position);
        let mut best: Unknowns =
            [state.pressure_a, state.pressure_b, state.supply_pressure, state.spool.spool].into();
        let (mut surplus, mut slopes) = self.surplus(state, areas, best, held_value);
        for _ in 0..STEPS {
            let Some(step) = slopes.lu().solve(&surplus) else { break };
            let mut fraction = 1.0;
            let found = (0..STEPS).find_map(|_| {
                let next = best - step * fraction;
                fraction *= 0.5;
                let (left, slopes) = self.surplus(state, areas, next, held_value);
                (left.norm() < surplus.norm()).then_some((next, left, slopes))
            });
            match found {
                Some(better) => (best, surplus, slopes) = better,
                None => break,
            }
        }
        let [pressure_a, pressure_b, supply_pressure, spool] = best.into();
        let mut balanced = MachineState {
            pressure_a,
            pressure_b,
            supply_pressure,
            cross_port_pressure: pressure_a - pressure_b,
            ..*state
        };
        balanced.spool.spool = spool;
        balanced
    }

    /// Residuals of the four equations, and their derivatives with respect to the unknowns.
    fn surplus(
        &self,
        state: &MachineState,
        areas: [f64; 2],
        unknowns: Unknowns,
        held_value: HeldValue,
    ) -> (Unknowns, Matrix4<f64>) {
        let variable = |index: usize| Dual::<4>::variable(unknowns[index], index);
        let mut dual = MachineState::<Dual<4>>::zero();
        dual.velocity = Dual::constant(state.velocity);
        (dual.pressure_a, dual.pressure_b) = (variable(0), variable(1));
        (dual.supply_pressure, dual.spool.spool) = (variable(2), variable(3));
        let [taken_a, taken_b] = self.steady_flows(&dual, areas);
        let [resistance_a, resistance_b] = self.line_resistances().map(Dual::constant);
        let ports = [dual.pressure_a + resistance_a * taken_a, dual.pressure_b + resistance_b * taken_b];
        let flows = self.flows(&dual, ports);
        let [from_a, from_b] = flows.from_valve;
        let stated = Dual::constant(self.supply.pressure);
        let supply = match self.power_unit.convert(&mut constant::<f64, Dual<4>>) {
            PowerUnit::Constant => (dual.supply_pressure - stated) / Dual::constant(PRESSURE_SCALE),
            PowerUnit::PumpLimited(unit) => {
                let taken = self.supply_flow(&dual, &flows.edges);
                let spare = unit.pump_flow - unit.relief_flow(dual.supply_pressure, stated) - taken;
                spare / Dual::constant(FLOW_SCALE)
            }
        };
        let held = match held_value {
            HeldValue::Spool => dual.spool.spool - Dual::constant(state.spool.spool),
            HeldValue::Force(force) => {
                let areas = areas.map(Dual::constant);
                let found = hydraulic_force(areas, [dual.pressure_a, dual.pressure_b]);
                (found - Dual::constant(force)) / Dual::constant(FORCE_SCALE)
            }
        };
        let flow_scale = Dual::constant(FLOW_SCALE);
        let rows = [(from_a - taken_a) / flow_scale, (from_b - taken_b) / flow_scale, supply, held];
        let slopes = Matrix4::from_fn(|row, column| rows[row].gradient()[column]);
        (rows.map(|row| row.value()).into(), slopes)
    }

    /// Flows into the chambers in steady motion: the piston's displacement, the flow from chamber
    /// to chamber, and the external leakage, m3/s.
    pub(super) fn steady_flows<T: Scalar + From<f64>>(
        &self,
        state: &MachineState<T>,
        [area_a, area_b]: [f64; 2],
    ) -> [T; 2] {
        let across = self.steady_cross_flow(state);
        let [out_of_a, out_of_b] = self.outward_flow(state).unwrap_or([T::from(0.0); 2]);
        [
            T::from(area_a) * state.velocity + across + out_of_a,
            -T::from(area_b) * state.velocity - across + out_of_b,
        ]
    }

    /// Pressure drops over both lines per steady flow, Pa s/m3.
    fn line_resistances(&self) -> [f64; 2] {
        self.lines.map(|line| {
            let (state, _) = line.steady_state(0.0, 1.0);
            line.port_pressure(&state, 0.0)
        })
    }
}
