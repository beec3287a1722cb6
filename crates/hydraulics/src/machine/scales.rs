use phea_dynamics::scalar::Scalar;

use super::gas::GasStates;
use super::{Machine, MachineState};
use crate::servovalve::SpoolState;

impl<S: Scalar> Machine<S> {
    /// Typical force, a tenth of the force that the supply can produce, N: the typical magnitudes
    /// of the states follow from it.
    pub(super) fn typical_force(&self) -> S {
        self.typical_pressure() * (self.cylinder.area_a + self.cylinder.area_b) / S::from(2.0)
    }

    fn typical_pressure(&self) -> S {
        (self.supply.pressure - self.supply.tank_pressure) / S::from(10.0)
    }

    /// Typical command, a tenth of the valve's nominal voltage, V.
    pub(super) fn typical_command(&self) -> S {
        self.valve.nominal_voltage / S::from(10.0)
    }

    /// Typical magnitudes of the states, by which errors are scaled, from the typical force and
    /// command.
    pub(super) fn typical_state(&self) -> MachineState<S> {
        let (command, pressure, force) =
            (self.typical_command(), self.typical_pressure(), self.typical_force());
        let swing = |mass: S| force / (self.sensor_stiffness * mass).sqrt();
        let velocity = swing(self.cylinder.moving_mass);
        let (own, series) = self.typical_joint(force, swing);
        let deflection = force / self.sensor_stiffness;
        let memory = command / S::from(100.0);
        MachineState {
            spool: SpoolState {
                spool: command,
                spool_rate: command * self.valve.natural_frequency,
                spool_friction: memory,
                magnetic_lag: memory,
            },
            pressure_a: pressure,
            pressure_b: pressure,
            deflection: own,
            velocity,
            bristle: self.friction.bristle_stiffness().map_or(deflection, |stiffness| force / stiffness),
            load: self.typical_load(deflection, velocity, swing),
            supply_pressure: pressure,
            cross_port_pressure: pressure,
            series,
        }
    }

    /// Typical magnitudes in the order of the vector, including the states of gas and lines.
    pub(super) fn typical_vector(&self) -> Vec<S> {
        let typical = self.typical_state();
        let flow = typical.velocity * self.cylinder.area_a;
        let mut vector = vec![S::from(0.0); self.layout.count()];
        self.layout.write(typical, &mut vector);
        let gas = GasStates {
            neck_flows: [flow; 2],
            pressures: [typical.pressure_a; 2],
            // thirty degrees
            warmings: [S::from(0.1); 2],
        };
        self.layout.write_gas(gas, &mut vector);
        self.layout.columns_mut(&mut vector).copy_from_slice(&self.typical_columns(self.typical_force()));
        for (places, line) in self.layout.lines_mut(&mut vector).into_iter().zip(&self.lines) {
            let (pressures, flows) = (line.scales(1.0, 0.0), line.scales(0.0, 1.0));
            for (place, (of_pressure, of_flow)) in places.iter_mut().zip(pressures.into_iter().zip(flows)) {
                *place = S::from(of_pressure) * typical.pressure_a + S::from(of_flow) * flow;
            }
        }
        vector
    }
}
