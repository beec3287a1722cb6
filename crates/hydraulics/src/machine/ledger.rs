use phea_dynamics::scalar::Scalar;

use super::equations::{Flows, constant};
use super::signals::ground_of;
use super::{Chambers, LoadMotion, Machine, MachineState, PowerUnit};

/// Names of the accounts of oil, in the order of [`Ledger::oil`].
pub const OIL_ACCOUNTS: [&str; 4] = ["chamber_a", "chamber_b", "supply", "rig"];

/// Names of the accounts of energy, in the order of [`Ledger::energy`].
pub const ENERGY_ACCOUNTS: [&str; 11] = [
    "chamber_a",
    "chamber_b",
    "supply",
    "valve",
    "leakage",
    "piston",
    "friction",
    "sensor",
    "end_stops",
    "load",
    "rig",
];

/// What a component holds, what enters it and what it loses.
///
/// ```text
/// d(stored)/dt = inflow - lost
/// ```
///
/// Each of the three has its own formula, so that the sum over time is a check and not a definition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Account<T> {
    /// What the component holds: J, or m3 of oil at zero gauge pressure.
    pub stored: T,
    /// What enters through its ports, in W or m3/s.
    pub inflow: T,
    /// What it turns into heat, in W; of oil, what an equation in volumes does not hand on, in m3/s.
    pub lost: T,
}

/// All accounts of a machine at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ledger<T> {
    /// Oil, by [`OIL_ACCOUNTS`].
    pub oil: [Account<T>; OIL_ACCOUNTS.len()],
    /// Energy, by [`ENERGY_ACCOUNTS`].
    pub energy: [Account<T>; ENERGY_ACCOUNTS.len()],
}

/// A volume of one pressure and one modulus.
#[derive(Clone, Copy)]
struct Volume<T> {
    modulus: T,
    volume: T,
    pressure: T,
}

impl<T: Scalar> Volume<T> {
    /// Density over that at zero gauge pressure: exp(p/beta).
    fn density(&self) -> T {
        density(self.pressure, self.modulus)
    }

    /// Energy of compression per volume, w = beta (exp(p/beta) - 1 - p/beta), in Pa.
    fn compression(&self) -> T {
        self.modulus * (self.density() - T::from(1.0)) - self.pressure
    }

    fn oil(&self, flow: T) -> Account<T> {
        Account { stored: self.volume * self.density(), inflow: self.density() * flow, lost: T::from(0.0) }
    }

    /// Port energy q (p + w), less the work p dV/dt that the volume does.
    fn energy(&self, flow: T, growth: T) -> Account<T> {
        Account {
            stored: self.volume * self.compression(),
            inflow: flow * (self.pressure + self.compression()) - self.pressure * growth,
            lost: T::from(0.0),
        }
    }
}

impl<T: Scalar> Flows<T> {
    /// Into chambers A and B through lumped lines, in m3/s.
    fn chamber_flows(&self) -> [T; 2] {
        let [from_a, from_b] = self.from_valve;
        [from_a - self.internal, from_b + self.internal]
    }
}

fn density<T: Scalar>(pressure: T, modulus: T) -> T {
    (pressure / modulus).exp()
}

/// What only takes power and turns it into heat.
fn heat<T: Scalar>(power: T) -> Account<T> {
    Account { stored: T::from(0.0), inflow: power, lost: power }
}

impl<S: Scalar> Machine<S> {
    /// The accounts of oil and energy; `None` where the fluid carries air, the supply an accumulator or a line waves, whose
    /// contents have no such short form.
    ///
    /// ```text
    /// oil      V exp(p/beta)                                  enters as q exp(p/beta)
    /// energy   V beta (exp(p/beta) - 1 - p/beta)              enters as q (p + beta (exp(p/beta) - 1 - p/beta))
    /// ```
    ///
    /// A side's volume is its compliance times the modulus beta of its chamber, so that a hose counts as the oil that would
    /// yield as much. An edge hands on volumes: what it takes at one density and gives at another is lost to the rig's
    /// account of oil, q times the difference of both densities, at most p_S/beta of the flow.
    pub fn ledger<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T]) -> Option<Ledger<T>> {
        if self.layout.has_lines() {
            return None;
        }
        let state = self.layout.read(state);
        let ground = ground_of(inputs);
        let load = self.load_of(&state, &ground);
        let sides = self.sides(&state, load.position + state.deflection)?;
        let supply = self.supply_volume(&state, &sides)?;
        let flows = self.flows(&state, [state.pressure_a, state.pressure_b]);
        Some(Ledger {
            oil: self.oil(&state, &flows, &sides, &supply),
            energy: self.energy(&state, &flows, &sides, &supply, &ground),
        })
    }

    /// Both chambers with their lines as volumes.
    fn sides<T: Scalar + From<S>>(&self, state: &MachineState<T>, position: T) -> Option<[Volume<T>; 2]> {
        let Chambers::Clean(clean) = self.chambers.convert(&mut constant::<S, T>) else {
            return None;
        };
        let [compliance_a, compliance_b] = self.compliance(state, position);
        let side = |area: T, slope: T, compliance: T, pressure: T| {
            let modulus = area / slope;
            Volume { modulus, volume: compliance * modulus, pressure }
        };
        Some([
            side(clean.area_a, clean.slope_a, compliance_a, state.pressure_a),
            side(clean.area_b, clean.slope_b, compliance_b, state.pressure_b),
        ])
    }

    /// The supply line; without volume, and with the modulus of side A, where the supply is constant.
    fn supply_volume<T: Scalar + From<S>>(
        &self,
        state: &MachineState<T>,
        sides: &[Volume<T>; 2],
    ) -> Option<Volume<T>> {
        let pressure = self.supply_of(state).pressure;
        match self.power_unit {
            PowerUnit::Constant => Some(Volume { volume: T::from(0.0), pressure, ..sides[0] }),
            PowerUnit::PumpLimited(unit) if unit.accumulator.is_none() => Some(Volume {
                modulus: constant(unit.effective_bulk_modulus),
                volume: constant(unit.volume),
                pressure,
            }),
            PowerUnit::PumpLimited(_) => None,
        }
    }

    /// What the power unit feeds into the supply line, the valve's tare flow taken off, in m3/s.
    fn fed<T: Scalar + From<S>>(&self, state: &MachineState<T>, flows: &Flows<T>) -> T {
        match self.power_unit.convert(&mut constant::<S, T>) {
            PowerUnit::Constant => flows.edges.supply_to_a + flows.edges.supply_to_b,
            PowerUnit::PumpLimited(unit) => {
                let relief = unit.relief_flow(state.supply_pressure, constant(self.supply.pressure));
                unit.pump_flow - relief - self.tare_flow_of(state)
            }
        }
    }

    fn oil<T: Scalar + From<S>>(
        &self,
        state: &MachineState<T>,
        flows: &Flows<T>,
        [side_a, side_b]: &[Volume<T>; 2],
        supply: &Volume<T>,
    ) -> [Account<T>; OIL_ACCOUNTS.len()] {
        let edges = &flows.edges;
        let tank_pressure: T = constant(self.supply.tank_pressure);
        let tank = [side_a, side_b].map(|side| density(tank_pressure, side.modulus));
        let (dense_s, dense_a, dense_b) = (supply.density(), side_a.density(), side_b.density());
        let fed = self.fed(state, flows);
        let line = supply.oil(fed - (edges.supply_to_a + edges.supply_to_b));
        let [into_a, into_b] = flows.chamber_flows();
        let (into_a, into_b) = (side_a.oil(into_a), side_b.oil(into_b));
        let rig = Account {
            stored: into_a.stored + into_b.stored + line.stored,
            inflow: dense_s * fed - tank[0] * edges.a_to_tank - tank[1] * edges.b_to_tank,
            lost: edges.supply_to_a * (dense_s - dense_a)
                + edges.a_to_tank * (dense_a - tank[0])
                + edges.supply_to_b * (dense_s - dense_b)
                + edges.b_to_tank * (dense_b - tank[1])
                + flows.internal * (dense_a - dense_b),
        };
        [into_a, into_b, line, rig]
    }

    fn energy<T: Scalar + From<S>>(
        &self,
        state: &MachineState<T>,
        flows: &Flows<T>,
        [side_a, side_b]: &[Volume<T>; 2],
        supply: &Volume<T>,
        ground: &LoadMotion<T>,
    ) -> [Account<T>; ENERGY_ACCOUNTS.len()] {
        let zero = T::from(0.0);
        let edges = &flows.edges;
        let load = self.load_of(state, ground);
        let forces = self.forces(state, load.position + state.deflection);
        let velocity = state.velocity;
        let [area_a, area_b]: [T; 2] = [constant(self.cylinder.area_a), constant(self.cylinder.area_b)];
        let taken = edges.supply_to_a + edges.supply_to_b;
        let [into_a, into_b] = flows.chamber_flows();
        let chamber_a = side_a.energy(into_a, area_a * velocity);
        let chamber_b = side_b.energy(into_b, -area_b * velocity);
        let line = supply.energy(self.fed(state, flows) - taken, zero);
        let tank: T = constant(self.supply.tank_pressure);
        let throttled = edges.supply_to_a * (supply.pressure - side_a.pressure)
            + edges.a_to_tank * (side_a.pressure - tank)
            + edges.supply_to_b * (supply.pressure - side_b.pressure)
            + edges.b_to_tank * (side_b.pressure - tank);
        let pushing = forces.hydraulic + forces.end_stops - forces.friction.force - forces.sensed;
        let friction = self.friction.convert(&mut constant::<S, T>);
        let piston = T::from(0.5) * constant::<S, T>(self.cylinder.moving_mass) * velocity.squared();
        let [held, to_ground, damped] = self.load.convert(&mut constant::<S, T>).powers(&load, ground);
        let on_ground = if self.load.moves() { to_ground } else { forces.sensed * load.velocity };
        let accounts = [
            chamber_a,
            chamber_b,
            line,
            heat(throttled),
            heat(flows.internal * (side_a.pressure - side_b.pressure)),
            Account { stored: piston, inflow: pushing * velocity, lost: zero },
            Account {
                stored: friction.stored_energy(state.bristle),
                inflow: forces.friction.force * velocity,
                lost: friction.dissipated(velocity, state.bristle),
            },
            Account {
                stored: T::from(0.5) * forces.sensed * state.deflection,
                inflow: forces.sensed * (velocity - load.velocity),
                lost: zero,
            },
            self.end_stop_account(load.position + state.deflection, velocity, forces.end_stops),
            Account { stored: held, inflow: forces.sensed * load.velocity - on_ground, lost: damped },
        ];
        // Only what crosses the rig's border: flow work and compression energy of the oil, and the work on the ground.
        let fed = self.fed(state, flows);
        let carried = side_a.compression() * into_a
            + side_b.compression() * into_b
            + supply.compression() * (fed - taken);
        let oil = supply.pressure * fed - tank * (edges.a_to_tank + edges.b_to_tank) + carried;
        let total = |of: fn(&Account<T>) -> T| accounts.iter().map(of).fold(zero, |sum, value| sum + value);
        let rig = Account {
            stored: total(|account| account.stored),
            inflow: oil - on_ground,
            lost: total(|account| account.lost),
        };
        let [a, b, c, d, e, f, g, h, i, j] = accounts;
        [a, b, c, d, e, f, g, h, i, j, rig]
    }

    fn end_stop_account<T: Scalar + From<S>>(&self, position: T, velocity: T, force: T) -> Account<T> {
        let zero = T::from(0.0);
        let Some(contact) = self.end_stops else {
            return Account { stored: zero, inflow: zero, lost: zero };
        };
        let contact = contact.convert(&mut constant::<S, T>);
        let beyond = position - constant(self.cylinder.stroke);
        Account {
            stored: contact.stored_energy(-position) + contact.stored_energy(beyond),
            inflow: -force * velocity,
            lost: contact.dissipated(-position, -velocity) + contact.dissipated(beyond, velocity),
        }
    }
}
