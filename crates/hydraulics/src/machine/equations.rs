use phea_dynamics::scalar::Scalar;

use super::{LoadMotion, Machine, MachineState, PowerUnit};
use crate::force_sensor;
use crate::friction::FrictionForce;
use crate::operating_point::hydraulic_force;
use crate::servovalve::{EdgeFlows, Openings, Supply, edge_flows, tare_flow};

/// Every flow at one instant, in m3/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Flows<T> {
    /// Through the four edges.
    pub(super) edges: EdgeFlows<T>,
    /// Across the piston from A to B.
    pub(super) internal: T,
    /// Into chamber A, the piston's own displacement left aside.
    pub(super) into_a: T,
    /// Into chamber B.
    pub(super) into_b: T,
}

/// Every force at one instant, in N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Forces<T> {
    /// Of the chamber pressures, towards B.
    pub(super) hydraulic: T,
    /// Friction and the rate of its bristles.
    pub(super) friction: FrictionForce<T>,
    /// Of the end stops, towards B: positive at the A end.
    pub(super) end_stops: T,
    /// On the load.
    pub(super) sensed: T,
}

/// A parameter as a constant of the equations.
#[inline]
pub(super) fn constant<S, T: From<S>>(parameter: S) -> T {
    T::from(parameter)
}

impl<S: Scalar> Machine<S> {
    /// Pressures at the valve's ports: the supply's own where it does not yield.
    #[inline]
    pub(super) fn supply_of<T: Scalar + From<S>>(&self, state: &MachineState<T>) -> Supply<T> {
        let stated = self.supply.convert(&mut constant::<S, T>);
        match self.power_unit {
            PowerUnit::Constant => stated,
            PowerUnit::PumpLimited(_) => Supply { pressure: state.supply_pressure, ..stated },
        }
    }

    /// Motion of the load: a state, or that of its ground.
    #[inline]
    pub(super) fn load_of<T: Scalar>(
        &self,
        state: &MachineState<T>,
        ground: &LoadMotion<T>,
    ) -> LoadMotion<T> {
        if self.load.moves() { state.load } else { *ground }
    }

    #[inline]
    pub(super) fn flows<T: Scalar + From<S>>(&self, state: &MachineState<T>) -> Flows<T> {
        let valve = self.valve.convert(&mut constant::<S, T>);
        let opening = self.spool.convert(&mut constant::<S, T>).opening(&state.spool);
        let (pressure_a, pressure_b) = (state.pressure_a, state.pressure_b);
        let supply = self.supply_of(state);
        let edges = edge_flows(&valve, &supply, &Openings::at(&valve, opening), pressure_a, pressure_b);
        let into_a = edges.supply_to_a - edges.a_to_tank;
        let into_b = edges.supply_to_b - edges.b_to_tank;
        match self.internal_leakage {
            None => Flows { edges, internal: T::from(0.0), into_a, into_b },
            Some(conductance) => {
                let internal = constant::<S, T>(conductance) * (pressure_a - pressure_b);
                Flows { edges, internal, into_a: into_a - internal, into_b: into_b + internal }
            }
        }
    }

    /// Oil that the valve takes from the supply, tare flow included, in m3/s.
    #[inline]
    pub(super) fn supply_flow<T: Scalar + From<S>>(
        &self,
        state: &MachineState<T>,
        edges: &EdgeFlows<T>,
    ) -> T {
        edges.supply_to_a + edges.supply_to_b + self.tare_flow_of(state)
    }

    pub(super) fn tare_flow_of<T: Scalar + From<S>>(&self, state: &MachineState<T>) -> T {
        let valve = self.valve.convert(&mut constant::<S, T>);
        tare_flow(&valve, &self.supply_of(state), constant(self.tare_reference_drop))
    }

    #[inline]
    pub(super) fn forces<T: Scalar + From<S>>(&self, state: &MachineState<T>, position: T) -> Forces<T> {
        let areas = [constant(self.cylinder.area_a), constant(self.cylinder.area_b)];
        let end_stops = match self.end_stops {
            None => T::from(0.0),
            Some(contact) => {
                let contact = contact.convert(&mut constant::<S, T>);
                let beyond = position - constant(self.cylinder.stroke);
                contact.force(-position, -state.velocity) - contact.force(beyond, state.velocity)
            }
        };
        Forces {
            hydraulic: hydraulic_force(areas, [state.pressure_a, state.pressure_b]),
            friction: self.friction.convert(&mut constant::<S, T>).at(state.velocity, state.bristle),
            end_stops,
            sensed: force_sensor::force(constant(self.sensor_stiffness), state.deflection),
        }
    }

    /// The equations of the machine: rates of all states at a command in V, the ground of the load moving so.
    #[inline]
    pub(super) fn state_rates<T: Scalar + From<S>>(
        &self,
        state: &MachineState<T>,
        command: T,
        ground: &LoadMotion<T>,
    ) -> MachineState<T> {
        let load = self.load_of(state, ground);
        let position = load.position + state.deflection;
        let velocity = state.velocity;
        let flows = self.flows(state);
        let forces = self.forces(state, position);
        let pressures = [state.pressure_a, state.pressure_b];
        let [compliance_a, compliance_b] =
            self.chambers.convert(&mut constant::<S, T>).compliance(position, pressures);
        let pushing = forces.hydraulic + forces.end_stops - forces.friction.force - forces.sensed;
        let valve = self.valve.convert(&mut constant::<S, T>);
        MachineState {
            spool: self.spool.convert(&mut constant::<S, T>).rates(&valve, &state.spool, command),
            pressure_a: (flows.into_a - constant::<S, T>(self.cylinder.area_a) * velocity) / compliance_a,
            pressure_b: (flows.into_b + constant::<S, T>(self.cylinder.area_b) * velocity) / compliance_b,
            deflection: velocity - load.velocity,
            velocity: pushing / constant(self.cylinder.moving_mass),
            bristle: forces.friction.bristle_rate,
            load: LoadMotion {
                position: load.velocity,
                velocity: self.load.convert(&mut constant::<S, T>).acceleration(forces.sensed, &load, ground),
            },
            supply_pressure: match &self.power_unit {
                PowerUnit::Constant => T::from(0.0),
                PowerUnit::PumpLimited(_) => self.supply_rate(state, &flows),
            },
        }
    }

    /// Rate of the supply pressure in Pa/s.
    fn supply_rate<T: Scalar + From<S>>(&self, state: &MachineState<T>, flows: &Flows<T>) -> T {
        match self.power_unit.convert(&mut constant::<S, T>) {
            PowerUnit::Constant => T::from(0.0),
            PowerUnit::PumpLimited(unit) => {
                let taken = self.supply_flow(state, &flows.edges);
                unit.pressure_rate(state.supply_pressure, constant(self.supply.pressure), taken)
            }
        }
    }
}
