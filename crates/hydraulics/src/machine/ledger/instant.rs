use phea_dynamics::scalar::{Parameters, Scalar};

use super::super::equations::{Flows, constant};
use super::super::gas::GasStates;
use super::super::series::Joint;
use super::super::signals::ground_of;
use super::super::{Accumulator, Chambers, Machine, MachineState, Motion, PowerUnit};
use super::Account;
use super::volume::{DensityLaw, Volume};
use crate::accumulator::{HeatedGas, MovedGas, Neck};
use crate::line::{DynamicLine, LineContent};
use crate::stroke::ActuatorStroke;

/// Quantities of all accounts of a rig at one instant.
pub(super) struct Instant<T> {
    pub(super) state: MachineState<T>,
    pub(super) load: Motion<T>,
    /// End of the rod that moves with the load.
    pub(super) end: Motion<T>,
    pub(super) ground: Motion<T>,
    pub(super) joint: Joint<T>,
    /// States of the oil of a transmission.
    pub(super) columns: Vec<T>,
    /// Power of the external force on the load, W.
    pub(super) external_power: T,
    pub(super) flows: Flows<T>,
    /// Flow that a motor with unlimited rotation passes from side A to side B, m3/s; zero with a
    /// stroke, where a chamber grows instead.
    pub(super) turned: T,
    /// Chambers, with their lines if these are lumped.
    pub(super) sides: [Volume<T>; 2],
    pub(super) lines: [LineInstant<T>; 2],
    /// Accumulators at the chambers; empty if there are none.
    pub(super) gas: [GasInstant<T>; 2],
    /// Necks of these accumulators; empty if there are none.
    pub(super) necks: [NeckInstant<T>; 2],
    pub(super) supply: SupplyInstant<T>,
}

/// Gas of an accumulator.
pub(super) struct GasInstant<T> {
    /// Flow into the gas, m3/s.
    pub(super) inflow: T,
    /// Flow that the chamber supplies for it, m3/s: that through the neck, if there is one.
    pub(super) taken: T,
    /// Pressure, Pa.
    pressure: T,
    /// Oil volume that has entered, m3, and the energy of the gas, J.
    oil: T,
    energy: T,
    /// Heat flow to its wall, W.
    pub(super) heat: T,
    /// Power of its adjustment, W.
    pub(super) work: T,
}

/// Neck between a chamber and its gas.
pub(super) struct NeckInstant<T> {
    pub(super) oil: Account<T>,
    pub(super) energy: Account<T>,
}

/// Line between the valve's port and the chamber; empty if it is lumped.
pub(super) struct LineInstant<T> {
    pub(super) port_pressure: T,
    pub(super) into_chamber: T,
    chamber_pressure: T,
    from_valve: T,
    content: LineContent<T>,
}

/// Supply line and its accumulator. Flows in m3/s.
pub(super) struct SupplyInstant<T> {
    pub(super) line: Volume<T>,
    /// Flow from the power unit into both, without the valve's tare flow.
    pub(super) fed: T,
    /// Gas, which receives its fraction of `fed` and of the flow through the edges.
    pub(super) gas: GasInstant<T>,
    taken: T,
}

impl<T: Scalar> Instant<T> {
    /// Flows into chambers A and B, less those that leave them other than by their growth, m3/s.
    pub(super) fn chamber_flows(&self) -> [T; 2] {
        let [line_a, line_b] = &self.lines;
        let [gas_a, gas_b] = &self.gas;
        let [out_of_a, out_of_b] = self.flows.out_of_chambers();
        [
            line_a.into_chamber - self.flows.internal - out_of_a - gas_a.taken - self.turned,
            line_b.into_chamber + self.flows.internal - out_of_b - gas_b.taken + self.turned,
        ]
    }
}

impl<T: Scalar> GasInstant<T> {
    /// Gas at this pressure in Pa, which receives a flow in proportion to its fraction of the
    /// compliance: the flow is `arriving` in m3/s, the compliance parallel to it `beside` in m3/Pa.
    fn of(gas: Option<Accumulator<T>>, pressure: T, arriving: T, beside: T) -> GasInstant<T> {
        let zero = T::from(0.0);
        let Some(gas) = gas else {
            return GasInstant {
                inflow: zero,
                taken: zero,
                pressure,
                oil: zero,
                energy: zero,
                heat: zero,
                work: zero,
            };
        };
        let compliance = gas.compliance(pressure);
        let inflow = arriving * compliance / (compliance + beside);
        let (oil, energy) = (gas.oil(pressure), gas.energy(pressure));
        GasInstant { inflow, taken: inflow, pressure, oil, energy, heat: zero, work: zero }
    }

    /// Gas that is adjusted, likewise.
    fn moved(moved: &MovedGas<T>, pressure: T, arriving: T, beside: T) -> GasInstant<T> {
        let (compliance, held) = (moved.gas.compliance(pressure), moved.oil_rate(pressure));
        let inflow = compliance * (arriving - held) / (compliance + beside) + held;
        let (oil, energy) = (moved.gas.oil(pressure), moved.gas.energy(pressure));
        let work = moved.power(pressure);
        GasInstant { inflow, taken: inflow, pressure, oil, energy, heat: T::from(0.0), work }
    }

    /// Gas that exchanges heat, likewise.
    fn heated(gas: &HeatedGas<T>, pressure: T, arriving: T, beside: T) -> GasInstant<T> {
        let rate = (arriving - gas.compliance * gas.cooling) / (gas.compliance + beside);
        let inflow = gas.flow(rate);
        let HeatedGas { oil, energy, heat, .. } = *gas;
        GasInstant { inflow, taken: inflow, pressure, oil, energy, heat, work: T::from(0.0) }
    }

    pub(super) fn oil(&self) -> Account<T> {
        Account { stored: self.oil, inflow: self.inflow, lost: T::from(0.0) }
    }

    pub(super) fn energy(&self) -> Account<T> {
        let inflow = self.pressure * self.inflow - self.heat + self.work;
        Account { stored: self.energy, inflow, lost: T::from(0.0) }
    }
}

impl<T: Scalar> LineInstant<T> {
    /// Line between the pressures of port and chamber; `None` with waves.
    fn of<S: Scalar>(
        line: &DynamicLine<S>,
        [port_pressure, chamber_pressure]: [T; 2],
        from_valve: T,
        vector: &[T],
    ) -> Option<LineInstant<T>>
    where
        T: From<S>,
    {
        let content = line.content(chamber_pressure, vector)?;
        let mut rates = vector.to_vec();
        let into_chamber = line.rates(from_valve, chamber_pressure, vector, &[], &mut rates);
        Some(LineInstant { port_pressure, into_chamber, chamber_pressure, from_valve, content })
    }

    pub(super) fn oil(&self) -> Account<T> {
        Account { stored: self.content.oil, inflow: self.from_valve - self.into_chamber, lost: T::from(0.0) }
    }

    pub(super) fn energy(&self) -> Account<T> {
        Account {
            stored: self.content.energy,
            inflow: self.port_pressure * self.from_valve - self.chamber_pressure * self.into_chamber,
            lost: self.content.heat,
        }
    }
}

impl<T: Scalar> SupplyInstant<T> {
    /// Flow into the compliance of the oil in the supply line, m3/s.
    pub(super) fn line_flow(&self) -> T {
        self.fed - self.taken - self.gas.inflow
    }
}

impl<S: Scalar> Machine<S> {
    /// Quantities at an instant; `None` if waves travel along a line.
    pub(super) fn instant<T: Scalar + From<S>>(&self, vector: &[T], inputs: &[T]) -> Option<Instant<T>> {
        let (state, states) = (self.layout.read(vector), self.layout.read_gas(vector));
        let ground = ground_of(inputs);
        let load = self.load_of(&state, &ground);
        let external = self.layout.external_force(inputs);
        let ports = self.ports(&state, vector);
        let flows = self.flows(&state, ports);
        let ([port_a, port_b], [from_a, from_b]) = (ports, flows.from_valve);
        let ([line_a, line_b], [vector_a, vector_b]) = (&self.lines, self.layout.lines(vector));
        let end = self.end_of(&load).motion;
        let joint = self.joint(&state, vector, &end);
        let (position, velocity) = (joint.position, state.velocity);
        let sides = self.sides(&state, position);
        let lines = [
            LineInstant::of(line_a, [port_a, state.pressure_a], from_a, vector_a)?,
            LineInstant::of(line_b, [port_b, state.pressure_b], from_b, vector_b)?,
        ];
        let setting = self.layout.setting(inputs);
        let gas = self.gas_instants((&state, &states, setting), position, &flows, &lines);
        Some(Instant {
            necks: self.neck_instants(
                &state,
                self.gas_pressures([state.pressure_a, state.pressure_b], &states, setting),
                &gas,
            ),
            gas,
            lines,
            supply: self.supply_instant(&state, &flows, &sides),
            state,
            load,
            end,
            ground,
            joint,
            columns: self.layout.columns(vector).to_vec(),
            external_power: external.map_or(T::from(0.0), |force| force * load.velocity),
            turned: match self.cylinder.stroke {
                ActuatorStroke::Limited(_) | ActuatorStroke::Telescopic(_) => T::from(0.0),
                ActuatorStroke::Unlimited => constant::<S, T>(self.cylinder.area_a) * velocity,
            },
            flows,
            sides,
        })
    }

    /// Both chambers as volumes.
    fn sides<T: Scalar + From<S>>(&self, state: &MachineState<T>, position: T) -> [Volume<T>; 2] {
        let [area_a, area_b] = [constant(self.cylinder.area_a), constant(self.cylinder.area_b)];
        match self.chambers.convert(&mut constant::<S, T>) {
            Chambers::Clean(clean) => {
                let [compliance_a, compliance_b] = self.oil_compliance(state, position);
                let side = |modulus: T, compliance: T, pressure: T| Volume {
                    fluid: compliance * modulus,
                    beside: T::from(0.0),
                    pressure,
                    law: DensityLaw::Constant(modulus),
                };
                [
                    side(area_a / clean.slope_a, compliance_a, state.pressure_a),
                    side(area_b / clean.slope_b, compliance_b, state.pressure_b),
                ]
            }
            Chambers::Aerated(aerated) => {
                let (side_a, side_b) = (&aerated.side_a, &aerated.side_b);
                let [from_a, to_b] = aerated.stroke.travels(position);
                [
                    Volume::aerated(&aerated, side_a, area_a, from_a, state.pressure_a),
                    Volume::aerated(&aerated, side_b, area_b, to_b, state.pressure_b),
                ]
            }
        }
    }

    /// Divides the flow into a chamber, net of its growing volume, between oil and gas.
    fn gas_instants<T: Scalar + From<S>>(
        &self,
        (state, states, setting): (&MachineState<T>, &GasStates<T>, [T; 2]),
        position: T,
        flows: &Flows<T>,
        [line_a, line_b]: &[LineInstant<T>; 2],
    ) -> [GasInstant<T>; 2] {
        let [oil_a, oil_b] = self.oil_compliance(state, position);
        let [into_a, into_b] =
            self.entering_chambers(state, position, flows, [line_a.into_chamber, line_b.into_chamber]);
        let chambers = [state.pressure_a, state.pressure_b];
        let pressures = self.gas_pressures(chambers, states, setting);
        let heated = self.heated(pressures, states);
        let own = |side: usize, arriving, beside| {
            let pressure = pressures[side];
            match (&heated[side], self.moved_gas(side, setting)) {
                (Some(gas), _) => GasInstant::heated(gas, pressure, arriving, beside),
                (None, Some(gas)) => GasInstant::moved(&gas, pressure, arriving, beside),
                (None, None) => GasInstant::of(None, pressure, arriving, beside),
            }
        };
        let of = |side: usize, into: T, oil: T| {
            let neck: Option<Neck<T>> = self.neck(side);
            let neck = neck.map(|_| states.neck_flows[side]);
            let drop = chambers[side] - pressures[side];
            match neck.or_else(|| self.through_gas_valve(side, setting, drop)) {
                None => own(side, into, oil),
                Some(taken) => GasInstant { taken, ..own(side, taken, self.before_gas(side)) },
            }
        };
        [of(0, into_a, oil_a), of(1, into_b, oil_b)]
    }

    /// Necks and valves with the oil in them, which takes part of their flow to the gas.
    fn neck_instants<T: Scalar + From<S>>(
        &self,
        state: &MachineState<T>,
        pressures: [T; 2],
        gas: &[GasInstant<T>; 2],
    ) -> [NeckInstant<T>; 2] {
        let (zero, half) = (T::from(0.0), T::from(0.5));
        [0, 1].map(|side| {
            let neck: Option<Neck<T>> = self.neck(side);
            if !self.layout.behind()[side] {
                let none = Account { stored: zero, inflow: zero, lost: zero };
                return NeckInstant { oil: none, energy: none };
            }
            let (flow, behind) = (gas[side].taken, pressures[side]);
            let before = [state.pressure_a, state.pressure_b][side];
            let (into_gas, compliance) = (gas[side].inflow, self.before_gas::<T>(side));
            let [inertance, drop] = match neck {
                Some(neck) => [neck.inertance, neck.drop(flow)],
                None => [zero, before - behind],
            };
            NeckInstant {
                oil: Account { stored: compliance * behind, inflow: flow - into_gas, lost: zero },
                energy: Account {
                    stored: half * (inertance * flow.squared() + compliance * behind.squared()),
                    inflow: before * flow - behind * into_gas,
                    lost: drop * flow,
                },
            }
        })
    }

    fn supply_instant<T: Scalar + From<S>>(
        &self,
        state: &MachineState<T>,
        flows: &Flows<T>,
        [side_a, _]: &[Volume<T>; 2],
    ) -> SupplyInstant<T> {
        let zero = T::from(0.0);
        let pressure = self.supply_of(state).pressure;
        let taken = flows.edges.supply_to_a + flows.edges.supply_to_b;
        let mut supply = SupplyInstant {
            line: Volume { fluid: zero, beside: zero, pressure, law: side_a.law },
            fed: taken,
            gas: GasInstant::of(None, pressure, zero, zero),
            taken,
        };
        if let PowerUnit::PumpLimited(unit) = self.power_unit.convert(&mut constant::<S, T>) {
            let relief = unit.relief_flow(pressure, constant(self.supply.pressure));
            supply.fed = unit.pump_flow - relief - self.tare_flow_of(state);
            supply.line.fluid = unit.volume;
            supply.line.law = DensityLaw::Constant(unit.effective_bulk_modulus);
            let oil = unit.volume / unit.effective_bulk_modulus;
            supply.gas = GasInstant::of(unit.accumulator, pressure, supply.fed - taken, oil);
        }
        supply
    }
}
