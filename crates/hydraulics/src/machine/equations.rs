use phea_dynamics::scalar::{LocalFunction, Parameters, Scalar};

use super::signals::ground_of;
use super::{Machine, MachineState, Motion, PowerUnit};
use crate::accumulator::{ChamberGas, GasContent, GasPassage, SealedGas};
use crate::cross_port::CrossPort;
use crate::friction::FrictionForce;
use crate::operating_point::hydraulic_force;
use crate::series::MovingSeries;
use crate::servovalve::{EdgeFlows, Edges, Servovalve, Supply, edge_conductances, edge_flows, tare_flow};
use crate::stroke::{ActuatorStroke, Telescope};

/// All flows at one instant, m3/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Flows<T> {
    /// Flows through the four edges.
    pub(super) edges: EdgeFlows<T>,
    /// Flow from chamber A to chamber B: across the piston and through a valve between them.
    pub(super) internal: T,
    /// Flow from each chamber to the tank, as through the case of a motor; `None` without such
    /// leakage.
    pub(super) outward: Option<[T; 2]>,
    /// Part of the internal flow that passes this valve.
    pub(super) cross_port: T,
    /// Flows from the valve into line A and line B.
    pub(super) from_valve: [T; 2],
}

impl<T: Scalar> Flows<T> {
    /// Flow from each chamber to the tank, m3/s.
    pub(super) fn out_of_chambers(&self) -> [T; 2] {
        self.outward.unwrap_or([T::from(0.0); 2])
    }
}

/// All forces at one instant, N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Forces<T> {
    /// Force of the chamber pressures, towards B.
    pub(super) hydraulic: T,
    /// Friction and the rate of its bristles.
    pub(super) friction: FrictionForce<T>,
    /// Force of the end stops, towards B: positive at the A end.
    pub(super) end_stops: T,
}

/// Parameter as a constant of the equations.
#[inline(always)]
pub(super) fn constant<S, T: From<S>>(parameter: S) -> T {
    T::from(parameter)
}

/// Flows through the four edges as a function of few states.
struct ValveEdges<'m, S> {
    valve: &'m Servovalve<S>,
    supply: &'m Supply<S>,
}

/// Flows as a function of opening and both ports' pressures.
impl<S: Scalar> LocalFunction<S, 3, 4> for ValveEdges<'_, S> {
    #[inline(always)]
    fn at<T: Scalar>(&self, [opening, a, b]: [T; 3], constant: impl Fn(S) -> T + Copy) -> [T; 4] {
        self.at([opening, a, b, constant(self.supply.pressure)], constant)
    }
}

/// Flows as a function of opening, both ports' pressures, and the supply pressure.
impl<S: Scalar> LocalFunction<S, 4, 4> for ValveEdges<'_, S> {
    #[inline(always)]
    fn at<T: Scalar>(&self, [opening, a, b, pressure]: [T; 4], constant: impl Fn(S) -> T + Copy) -> [T; 4] {
        let valve = self.valve.convert(&mut |parameter| constant(parameter));
        let supply = Supply { pressure, tank_pressure: constant(self.supply.tank_pressure) };
        edge_flows(&valve, &supply, &edge_conductances(&valve, opening), a, b).to_array()
    }
}

impl<S: Scalar> Machine<S> {
    /// Pressures at the valve's supply ports: the stated ones if the supply does not yield.
    #[inline(always)]
    pub(super) fn supply_of<T: Scalar + From<S>>(&self, state: &MachineState<T>) -> Supply<T> {
        let stated = self.supply.convert(&mut constant::<S, T>);
        match self.power_unit {
            PowerUnit::Constant => stated,
            PowerUnit::PumpLimited(_) => Supply { pressure: state.supply_pressure, ..stated },
        }
    }

    /// Motion of the load: a state, or that of its ground.
    #[inline(always)]
    pub(super) fn load_of<T: Scalar>(&self, state: &MachineState<T>, ground: &Motion<T>) -> Motion<T> {
        if self.load.moves() {
            Motion { position: ground.position + state.load.position, velocity: state.load.velocity }
        } else {
            *ground
        }
    }

    /// Pressures at the valve's ports A and B: those of the chambers if the lines are lumped.
    #[inline(always)]
    pub(super) fn ports<T: Scalar + From<S>>(&self, state: &MachineState<T>, vector: &[T]) -> [T; 2] {
        if self.layout.has_lines() {
            self.ports_of_lines([state.pressure_a, state.pressure_b], self.layout.lines(vector))
        } else {
            [state.pressure_a, state.pressure_b]
        }
    }

    /// Separate function, so that machines without such lines do not contain its code; it takes
    /// only the pressures, because a separate function with the whole state would copy that state
    /// in every machine.
    #[inline(never)]
    fn ports_of_lines<T: Scalar + From<S>>(&self, chambers: [T; 2], lines: [&[T]; 2]) -> [T; 2] {
        let ([line_a, line_b], [state_a, state_b]) = (&self.lines, lines);
        [line_a.port_pressure(state_a, chambers[0]), line_b.port_pressure(state_b, chambers[1])]
    }

    /// Compliance of both chambers including their lines and accumulators, without gas that is
    /// behind a neck or a valve, exchanges heat or is adjusted, m3/Pa.
    #[inline(always)]
    pub(super) fn compliance<T: Scalar + From<S>>(&self, state: &MachineState<T>, position: T) -> [T; 2] {
        let [oil_a, oil_b] = self.oil_compliance(state, position);
        let [gas_a, gas_b] = &self.gas;
        let with = |oil: T, gas: &Option<ChamberGas<S>>, pressure: T| match gas {
            Some(ChamberGas::Sealed(SealedGas {
                content: GasContent::Polytropic(gas),
                passage: GasPassage::Open,
                ..
            })) => {
                let [gas] = T::local(gas, [pressure]);
                oil + gas
            }
            _ => oil,
        };
        [with(oil_a, gas_a, state.pressure_a), with(oil_b, gas_b, state.pressure_b)]
    }

    /// Compliance without accumulators, which vanishes with the volume of a chamber.
    #[inline(always)]
    pub(super) fn oil_compliance<T: Scalar + From<S>>(&self, state: &MachineState<T>, position: T) -> [T; 2] {
        self.chambers.compliance(position, [state.pressure_a, state.pressure_b])
    }

    /// Flows at the pressures of the valve's ports A and B.
    #[inline(always)]
    pub(super) fn flows<T: Scalar + From<S>>(
        &self,
        state: &MachineState<T>,
        [port_a, port_b]: [T; 2],
    ) -> Flows<T> {
        let opening = self.valve.spool.convert(&mut constant::<S, T>).opening(&state.spool);
        let valve = ValveEdges { valve: &self.valve, supply: &self.supply };
        let edges = Edges::from_array(match self.power_unit {
            PowerUnit::Constant => T::local(&valve, [opening, port_a, port_b]),
            PowerUnit::PumpLimited(_) => T::local(&valve, [opening, port_a, port_b, state.supply_pressure]),
        });
        let from_valve = [edges.supply_to_a - edges.a_to_tank, edges.supply_to_b - edges.b_to_tank];
        let (leakage, outward) = (self.leakage(state), self.outward_flow(state));
        match &self.cross_port {
            None => Flows { edges, internal: leakage, outward, cross_port: T::from(0.0), from_valve },
            Some(port) => {
                let drop = state.pressure_a - state.pressure_b;
                let cross_port = self.through_cross_port(port, drop, state.cross_port_pressure);
                Flows { edges, internal: leakage + cross_port, outward, cross_port, from_valve }
            }
        }
    }

    /// Flow through a valve between the chambers from A to B in m3/s, for the drop p_A - p_B and
    /// the pressure difference over its capacity, both in Pa. Separate function, so that machines
    /// without such a valve do not contain its code.
    #[inline(never)]
    fn through_cross_port<T: Scalar + From<S>>(&self, port: &CrossPort<S>, drop: T, over_capacity: T) -> T {
        let CrossPort { restrictor, capacity } = port.convert(&mut constant::<S, T>);
        restrictor.flow(if capacity.is_some() { drop - over_capacity } else { drop })
    }

    /// Flow from chamber A to chamber B at rest, m3/s.
    pub(super) fn steady_cross_flow<T: Scalar + From<S>>(&self, state: &MachineState<T>) -> T {
        let leakage = self.leakage(state);
        let steady = self.cross_port.as_ref().filter(|port| port.capacity.is_none());
        let drop = state.pressure_a - state.pressure_b;
        steady.map_or(leakage, |port| leakage + self.through_cross_port(port, drop, T::from(0.0)))
    }

    /// Flow across the piston from A to B, m3/s.
    #[inline(always)]
    pub(super) fn leakage<T: Scalar + From<S>>(&self, state: &MachineState<T>) -> T {
        self.cylinder.internal_leakage.map_or(T::from(0.0), |conductance| {
            constant::<S, T>(conductance) * (state.pressure_a - state.pressure_b)
        })
    }

    /// Flows out of both chambers to the tank, m3/s.
    #[inline(always)]
    pub(super) fn outward_flow<T: Scalar + From<S>>(&self, state: &MachineState<T>) -> Option<[T; 2]> {
        let outward = self.outward?.convert(&mut constant::<S, T>);
        let tank: T = constant(self.supply.tank_pressure);
        Some(outward.flows([state.pressure_a, state.pressure_b], tank))
    }

    /// Flow that the valve takes from the supply, tare flow included, m3/s.
    #[inline(always)]
    pub(super) fn supply_flow<T: Scalar + From<S>>(
        &self,
        state: &MachineState<T>,
        edges: &EdgeFlows<T>,
    ) -> T {
        edges.supply_to_a + edges.supply_to_b + self.tare_flow_of(state)
    }

    pub(super) fn tare_flow_of<T: Scalar + From<S>>(&self, state: &MachineState<T>) -> T {
        let valve = self.valve.convert(&mut constant::<S, T>);
        tare_flow(&valve, &self.supply_of(state))
    }

    /// Areas A_A and A_B at a position of the piston in m, m2.
    #[inline(always)]
    pub(super) fn areas_at<T: Scalar + From<S>>(&self, position: T) -> [T; 2] {
        match &self.cylinder.stroke {
            ActuatorStroke::Telescopic(telescope) => self.areas_of_stages(telescope, position),
            ActuatorStroke::Limited(_) | ActuatorStroke::Unlimited => {
                [constant(self.cylinder.area_a), constant(self.cylinder.area_b)]
            }
        }
    }

    /// Separate function, so that machines with a single stage do not contain its code.
    #[inline(never)]
    fn areas_of_stages<T: Scalar + From<S>>(&self, telescope: &Telescope<S>, position: T) -> [T; 2] {
        let [ratio_a, ratio_b] = telescope.convert(&mut constant::<S, T>).ratios(position);
        [constant::<S, T>(self.cylinder.area_a) * ratio_a, constant::<S, T>(self.cylinder.area_b) * ratio_b]
    }

    #[inline(always)]
    pub(super) fn forces<T: Scalar + From<S>>(&self, state: &MachineState<T>, position: T) -> Forces<T> {
        let areas = self.areas_at(position);
        let [force, bristle_rate] = T::local(&self.friction, [state.velocity, state.bristle]);
        let end_stops = match self.cylinder.end_stops {
            None => T::from(0.0),
            Some(contact) => {
                let contact = contact.convert(&mut constant::<S, T>);
                let [from_a, to_b] = self.cylinder.stroke.convert(&mut constant::<S, T>).distances(position);
                contact.force(-from_a, -state.velocity) - contact.force(-to_b, state.velocity)
            }
        };
        Forces {
            hydraulic: hydraulic_force(areas, [state.pressure_a, state.pressure_b]),
            friction: FrictionForce { force, bristle_rate },
            end_stops,
        }
    }

    /// Equations of the machine: rates of all states at a command in V.
    #[inline(always)]
    pub(super) fn write_rates<T: Scalar + From<S>>(
        &self,
        vector: &[T],
        command: T,
        inputs: &[T],
        rates: &mut [T],
    ) {
        let state = self.layout.read(vector);
        let ground = ground_of(inputs);
        let load = self.load_of(&state, &ground);
        let end = self.end_of(&load);
        let joint = self.joint(&state, vector, &end.motion);
        let position = joint.position;
        let flows = self.flows(&state, self.ports(&state, vector));
        let forces = self.forces(&state, position);
        let pushing = forces.hydraulic + forces.end_stops - forces.friction.force - joint.sensed;
        let external = self.layout.external_force(inputs);
        let on_load = end.on_load(joint.on_load);
        let on_load = external.map_or(on_load, |external| on_load + external);
        let on_load = self.weight_on(&load).map_or(on_load, |weight| on_load + weight);
        let valve = self.valve.convert(&mut constant::<S, T>);
        let chambers = [state.pressure_a, state.pressure_b];
        let from_lines = if self.layout.has_lines() {
            self.through_lines(chambers, flows.from_valve, self.layout.lines(vector), inputs, rates)
        } else {
            flows.from_valve
        };
        let (into, compliances) =
            (self.entering_chambers(&state, position, &flows, from_lines), self.compliance(&state, position));
        let [pressure_a, pressure_b] = if self.layout.has_gas() {
            self.beside_gas((vector, inputs), chambers, into, compliances, rates)
        } else {
            [into[0] / compliances[0], into[1] / compliances[1]]
        };
        let state_rates = MachineState {
            spool: valve.spool.rates(&valve, &state.spool, command),
            pressure_a,
            pressure_b,
            deflection: joint.deflection_rate,
            velocity: pushing / constant(self.cylinder.moving_mass),
            bristle: forces.friction.bristle_rate,
            load: Motion {
                position: load.velocity - ground.velocity,
                velocity: self.load.convert(&mut constant::<S, T>).acceleration(on_load, &load, &ground),
            },
            supply_pressure: self.supply_rate(&state, &flows),
            cross_port_pressure: self.cross_port_rate(&flows),
            series: joint.series_rates,
        };
        self.layout.write(state_rates, rates);
        if let Some(MovingSeries::Oil(column)) = &self.series {
            let ends = [joint.sensed, end.motion.velocity];
            let (columns, rates) = (self.layout.columns(vector), self.layout.columns_mut(rates));
            self.write_column_rates(column, columns, ends, rates);
        }
    }

    /// Flows that compress the oil of both chambers, net of their growing volumes, for these flows
    /// from the lines, m3/s.
    #[inline(always)]
    pub(super) fn entering_chambers<T: Scalar + From<S>>(
        &self,
        state: &MachineState<T>,
        position: T,
        flows: &Flows<T>,
        [from_a, from_b]: [T; 2],
    ) -> [T; 2] {
        let [area_a, area_b] = self.areas_at(position);
        let (stays_in_a, stays_in_b) = (from_a - flows.internal, from_b + flows.internal);
        let (stays_in_a, stays_in_b) = match flows.outward {
            None => (stays_in_a, stays_in_b),
            Some([out_of_a, out_of_b]) => (stays_in_a - out_of_a, stays_in_b - out_of_b),
        };
        [stays_in_a - area_a * state.velocity, stays_in_b + area_b * state.velocity]
    }

    /// Flows that leave the lines into the chambers, m3/s; writes the rates of the lines' states.
    #[inline(never)]
    fn through_lines<T: Scalar + From<S>>(
        &self,
        chambers: [T; 2],
        [from_a, from_b]: [T; 2],
        [state_a, state_b]: [&[T]; 2],
        inputs: &[T],
        rates: &mut [T],
    ) -> [T; 2] {
        let [arriving_a, arriving_b] = self.layout.arriving(inputs);
        let [rates_a, rates_b] = self.layout.lines_mut(rates);
        let [line_a, line_b] = &self.lines;
        [
            line_a.rates(from_a, chambers[0], state_a, arriving_a, rates_a),
            line_b.rates(from_b, chambers[1], state_b, arriving_b, rates_b),
        ]
    }

    /// Waves sent into the delays of the lines, Pa.
    pub(super) fn write_outgoing<T: Scalar + From<S>>(&self, vector: &[T], inputs: &[T], waves: &mut [T]) {
        let state = self.layout.read(vector);
        let [state_a, state_b] = self.layout.lines(vector);
        let [arriving_a, arriving_b] = self.layout.arriving(inputs);
        let [waves_a, waves_b] = self.layout.outgoing(waves);
        let [line_a, line_b] = &self.lines;
        line_a.outgoing(state.pressure_a, state_a, arriving_a, waves_a);
        line_b.outgoing(state.pressure_b, state_b, arriving_b, waves_b);
    }

    /// Rate of the pressure difference over the capacity of a valve between the chambers, Pa/s.
    #[inline(always)]
    fn cross_port_rate<T: Scalar + From<S>>(&self, flows: &Flows<T>) -> T {
        match self.cross_port.and_then(|port| port.capacity) {
            None => T::from(0.0),
            Some(capacity) => flows.cross_port / constant(capacity),
        }
    }

    /// Rate of the supply pressure, Pa/s.
    #[inline(always)]
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
