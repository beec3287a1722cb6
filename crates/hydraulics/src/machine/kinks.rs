//! Kinks of the machine's rates: states of its motion at which a derivative of a rate jumps. An
//! integrator checks steps that cross one more closely.

use phea_dynamics::scalar::{Parameters, Scalar};

use super::equations::constant;
use super::signals::ground_of;
use super::{Machine, PowerUnit};
use crate::contact::Contact;
use crate::friction::MovingFriction;
use crate::series::MovingSeries;
use crate::stroke::ActuatorStroke;

impl<S: Scalar> Machine<S> {
    /// Writes the functions that change their sign at the kinks of this machine.
    ///
    /// ```text
    /// spool       U of its edges; dU/dt of its memories; limit - |dU/dt|
    /// friction    v, of bristles and of the smoothed curve
    /// contacts    d and 1 + c d' of end stops and wall; the remaining travel of a series spring
    /// stages      x at both ends of each transition
    /// gas         p at which the bladder begins to lift, and at which it has lifted
    /// supply      p at which the relief valve opens
    /// port valves p at both ends of the transition of a relief or check valve at a chamber
    /// ```
    pub(super) fn write_kinks<T: Scalar + From<S>>(
        &self,
        vector: &[T],
        inputs: &[T],
        write: &mut dyn FnMut(T),
    ) {
        let state = self.layout.read(vector);
        let ground = ground_of(inputs);
        let load = self.load_of(&state, &ground);
        let end = self.end_of(&load);
        let joint = self.joint(&state, vector, &end.motion);
        write(self.valve.spool.convert(&mut constant::<S, T>).opening(&state.spool));
        if self.valve.spool.threshold.is_some() || self.valve.spool.hysteresis_width.is_some() {
            write(state.spool.spool_rate);
        }
        if let Some(limit) = self.valve.spool.rate_limit {
            write(constant::<S, T>(limit) - state.spool.spool_rate.abs());
        }
        if !matches!(self.friction, MovingFriction::Viscous { .. }) {
            write(state.velocity);
        }
        if let Some(contact) = self.cylinder.end_stops {
            let [from_a, to_b] =
                self.cylinder.stroke.convert(&mut constant::<S, T>).distances(joint.position);
            let mut press = |depth: T, rate: T| write_contact(&contact, depth, rate, write);
            press(-from_a, -state.velocity);
            press(-to_b, state.velocity);
        }
        if let Some(wall) = self.load.wall() {
            let clearance = self.load.convert(&mut constant::<S, T>).clearance(&load, &ground);
            write_contact(&wall, -clearance, load.velocity - ground.velocity, write);
        }
        if let Some(MovingSeries::Spring(spring)) = &self.series
            && spring.travel.is_some()
        {
            write(spring.convert(&mut constant::<S, T>).clearance(joint.spring.position));
        }
        if let ActuatorStroke::Telescopic(telescope) = &self.cylinder.stroke {
            let half = constant::<S, T>(telescope.transition) * T::from(0.5);
            for stage in telescope.stages.iter().flatten() {
                let beyond = joint.position - constant::<S, T>(stage.from);
                write(beyond + half);
                write(beyond - half);
            }
        }
        self.write_port_valve_kinks([state.pressure_a, state.pressure_b], write);
        self.write_gas_kinks([state.pressure_a, state.pressure_b], (vector, inputs), write);
        if let PowerUnit::PumpLimited(unit) = &self.power_unit {
            let opens = self.supply.pressure - unit.relief_override;
            write(state.supply_pressure - constant::<S, T>(opens));
            if let Some(gas) = &unit.accumulator {
                let [from, to] = gas.lifting_pressures();
                write(state.supply_pressure - constant::<S, T>(from));
                write(state.supply_pressure - constant::<S, T>(to));
            }
        }
    }

    /// Writes the kinks of the relief and check valves at the chambers.
    fn write_port_valve_kinks<T: Scalar + From<S>>(&self, chambers: [T; 2], write: &mut dyn FnMut(T)) {
        let Some(outward) = &self.outward else { return };
        let tank: T = constant(self.supply.tank_pressure);
        for (valves, pressure) in outward.port_valves.iter().zip(chambers) {
            if let Some(valves) = valves {
                valves.convert(&mut constant::<S, T>).write_kinks(pressure - tank, write);
            }
        }
    }

    /// Writes the kinks of the gas at the chambers.
    fn write_gas_kinks<T: Scalar + From<S>>(
        &self,
        chambers: [T; 2],
        (vector, inputs): (&[T], &[T]),
        write: &mut dyn FnMut(T),
    ) {
        if self.gas.iter().all(Option::is_none) {
            return;
        }
        let (gas, setting) = (self.layout.read_gas(vector), self.layout.setting(inputs));
        let pressures = self.gas_pressures(chambers, &gas, setting);
        for (precharge, pressure) in self.precharges(&gas, setting).into_iter().zip(pressures) {
            let Some(precharge_pressure) = precharge else { continue };
            let as_it_is = crate::accumulator::Accumulator {
                gas_volume: T::from(1.0),
                precharge_pressure,
                polytropic_exponent: T::from(1.0),
            };
            let [from, to] = as_it_is.lifting_pressures();
            write(pressure - from);
            write(pressure - to);
        }
    }

    /// Number of possible kinks of this machine.
    pub(super) fn kink_count(&self) -> usize {
        let zero = S::from(0.0);
        let mut count = 0;
        let (state, inputs) = (vec![zero; self.layout.count()], vec![zero; self.layout.inputs()]);
        self.write_kinks(&state, &inputs, &mut |_: S| count += 1);
        count
    }
}

/// Kinks of a contact: first touch, and rebound, at which damping would pull.
fn write_contact<S: Scalar, T: Scalar + From<S>>(
    contact: &Contact<S>,
    depth: T,
    rate: T,
    write: &mut dyn FnMut(T),
) {
    write(depth);
    write(T::from(1.0) + constant::<S, T>(contact.relative_damping) * rate);
}
