use phea_dynamics::scalar::Scalar;

use super::bisection::{falling_root, falling_root_within};
use super::settling::AT_NULL;
use super::{OperatingPoint, OperatingPointError, SteadyLoad, hydraulic_force};
use crate::actuator::Components;
use crate::cross_port::CrossFlow;
use crate::outward_flow::OutwardFlow;
use crate::servovalve::{ChamberFlows, Servovalve, Supply, chamber_flows};

/// Parameters of the balance of flows and forces. Units: those of the components, m2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Balance<S = f64> {
    /// The servovalve.
    pub valve: Servovalve<S>,
    /// Supply and tank pressures.
    pub supply: Supply<S>,
    /// Piston areas A_A and A_B at the position.
    pub areas: [S; 2],
    /// Flow from chamber A to chamber B; `None` without such flow.
    pub across: Option<CrossFlow<S>>,
    /// Flow from each chamber to the tank; `None` without such flow.
    pub outward: Option<OutwardFlow<S>>,
}

impl<S: Scalar> Balance<S> {
    /// Balance of these components with the piston at a position in m.
    pub fn at(components: &Components<S>, position: S) -> Balance<S> {
        let cylinder = &components.cylinder;
        Balance {
            valve: components.valve,
            supply: components.supply,
            areas: cylinder.areas_at(position),
            across: components.cross_flow(),
            outward: components.outward.if_present(),
        }
    }

    /// Flow from chamber A (0) or B (1) at this pressure to the tank, m3/s.
    pub(super) fn leaving(&self, side: usize, pressure: S) -> S {
        let above_tank = pressure - self.supply.tank_pressure;
        self.outward.map_or(S::from(0.0), |outward| outward.flow(side, above_tank))
    }
}

/// Halvings to the last bit.
const ALL_HALVINGS: usize = 60;
/// Largest relative error of an accepted balance.
const BALANCED: f64 = 1e-9;

impl Balance {
    /// Pressures at which the chamber flows match a piston at this velocity.
    pub(super) fn pressures(&self, command: f64, velocity: f64) -> Result<[f64; 2], OperatingPointError> {
        if self.across.is_some() {
            return self.leaking_pressures(command, velocity);
        }
        let Supply { pressure, tank_pressure } = self.supply;
        let [area_a, area_b] = self.areas;
        let into = |p: f64| chamber_flows(&self.valve, &self.supply, command, p, p);
        let surplus_a = |p: f64| into(p).into_a - area_a * velocity - self.leaving(0, p);
        let surplus_b = |p: f64| into(p).into_b + area_b * velocity - self.leaving(1, p);
        let pressure_a = falling_root(surplus_a, tank_pressure, pressure);
        let pressure_b = falling_root(surplus_b, tank_pressure, pressure);
        match (pressure_a, pressure_b) {
            (Some(pressure_a), Some(pressure_b)) => Ok([pressure_a, pressure_b]),
            _ => Err(OperatingPointError::NotFound),
        }
    }

    /// Pressures with a flow from chamber to chamber, which makes either pressure depend on the
    /// other.
    fn leaking_pressures(&self, command: f64, velocity: f64) -> Result<[f64; 2], OperatingPointError> {
        let pressures = self.settle_at(command, velocity, ALL_HALVINGS);
        let drop = self.supply.pressure - self.supply.tank_pressure;
        let left = self.step_at(command, velocity, pressures).map(|step| step.abs() / drop);
        match left[0] + left[1] <= BALANCED {
            true => Ok(pressures),
            false => Err(OperatingPointError::NotFound),
        }
    }

    /// Load that these pressures hold, in its own unit.
    fn held(&self, load: SteadyLoad, [pressure_a, pressure_b]: [f64; 2]) -> f64 {
        match load {
            SteadyLoad::Force(_) => hydraulic_force(self.areas, [pressure_a, pressure_b]),
            SteadyLoad::Pressure(_) => pressure_a - pressure_b,
        }
    }

    /// Command that holds a load at this velocity.
    pub(super) fn holding_command(
        &self,
        load: SteadyLoad,
        velocity: f64,
    ) -> Result<f64, OperatingPointError> {
        let wanted = wanted(load);
        let nominal = self.valve.nominal_voltage;
        let held = |command: f64| self.pressures(command, velocity).map(|p| self.held(load, p));
        let (minimum, maximum) = (held(-nominal)?, held(nominal)?);
        if !(minimum..=maximum).contains(&wanted) {
            let (is_force, moves) = (matches!(load, SteadyLoad::Force(_)), velocity != 0.0);
            return Err(OperatingPointError::LoadOutOfReach {
                load: wanted,
                is_force,
                moves,
                minimum,
                maximum,
            });
        }
        let shortfall = |command: f64| held(command).map_or(f64::NAN, |held| wanted - held);
        let command =
            falling_root_within(shortfall, -nominal, nominal).ok_or(OperatingPointError::NotFound)?;
        Ok(if command.abs() < AT_NULL * nominal { 0.0 } else { command })
    }

    /// Steady velocity at a command under a load.
    pub(super) fn velocity(&self, command: f64, load: SteadyLoad) -> Result<f64, OperatingPointError> {
        let wanted = wanted(load);
        let excess = |velocity: f64| {
            self.pressures(command, velocity).map_or(f64::NAN, |p| self.held(load, p) - wanted)
        };
        let flow = self.valve.flow_coefficients.supply_to_a * self.supply.pressure.abs().sqrt();
        let scale = flow / self.areas[0];
        falling_root(excess, -scale, scale).ok_or(OperatingPointError::NotFound)
    }

    pub(super) fn point(
        &self,
        position: f64,
        command: f64,
        pressures: [f64; 2],
        velocity: f64,
    ) -> OperatingPoint {
        let [pressure_a, pressure_b] = pressures;
        let ChamberFlows { into_a, into_b } =
            chamber_flows(&self.valve, &self.supply, command, pressure_a, pressure_b);
        let across = self.across.map_or(0.0, |across| across.flow(pressure_a - pressure_b));
        let [area_a, area_b] = self.areas;
        OperatingPoint {
            position,
            command,
            pressure_a,
            pressure_b,
            velocity,
            hydraulic_force: hydraulic_force(self.areas, pressures),
            net_flow_a: into_a - area_a * velocity - across - self.leaving(0, pressure_a),
            net_flow_b: into_b + area_b * velocity + across - self.leaving(1, pressure_b),
        }
    }
}

fn wanted(load: SteadyLoad) -> f64 {
    match load {
        SteadyLoad::Force(wanted) | SteadyLoad::Pressure(wanted) => wanted,
    }
}
