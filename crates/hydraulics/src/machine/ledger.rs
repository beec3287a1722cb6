mod instant;
mod volume;

use phea_dynamics::scalar::{Parameters, Scalar};

use super::equations::constant;
use super::series::plugs;
use super::{Machine, Motion};
use crate::series::MovingSeries;
use instant::Instant;

/// Names of the oil accounts, in the order of [`Ledger::oil`]. Accounts of parts that a machine
/// lacks are zero.
pub const OIL_ACCOUNTS: [&str; 11] = [
    "chamber_a",
    "chamber_b",
    "line_a",
    "line_b",
    "accumulator_a",
    "accumulator_b",
    "neck_a",
    "neck_b",
    "supply",
    "accumulator",
    "rig",
];

/// Names of the energy accounts, in the order of [`Ledger::energy`]. Accounts of parts that a
/// machine lacks are zero.
pub const ENERGY_ACCOUNTS: [&str; 23] = [
    "chamber_a",
    "chamber_b",
    "line_a",
    "line_b",
    "accumulator_a",
    "accumulator_b",
    "neck_a",
    "neck_b",
    "gas_heat_a",
    "gas_heat_b",
    "supply",
    "accumulator",
    "valve",
    "leakage",
    "cross_port",
    "port_valves",
    "piston",
    "friction",
    "sensor",
    "series",
    "end_stops",
    "load",
    "rig",
];

/// Content of a component, its inflow and its losses.
///
/// ```text
/// d(stored)/dt = inflow - lost
/// ```
///
/// The three have separate formulas, so that the sum over time is a check and not a definition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Account<T> {
    /// Content of the component: J, or m3 of oil, which is counted at zero gauge pressure except
    /// for the volumes of lines and gas.
    pub stored: T,
    /// Inflow through its ports, in W or m3/s.
    pub inflow: T,
    /// Dissipation, in W; for oil, the loss of an equation in volumes, in m3/s.
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

/// A component that only dissipates power.
fn heat<T: Scalar>(power: T) -> Account<T> {
    Account { stored: T::from(0.0), inflow: power, lost: power }
}

fn total<T: Scalar>(accounts: &[Account<T>], of: fn(&Account<T>) -> T) -> T {
    accounts.iter().map(of).fold(T::from(0.0), |sum, value| sum + value)
}

impl<S: Scalar> Machine<S> {
    /// Accounts of oil and energy; `None` if waves travel along a line: their content in transit is
    /// not part of states and inputs.
    ///
    /// ```text
    ///               oil                        energy
    /// side          V rho                      V w                          enters as q rho and q (p + w)
    /// line          sum C p                    sum C p^2/2 + I q^2/2        enters as q and q p
    /// accumulator   V_0 - V_gas                gas at gauge pressure        enters as q and q p
    ///   with heat   V_0 - V_gas                internal energy less p_atm V   enters as q and q p, leaves as heat to the wall
    ///   adjusted    V_0 - V_gas                oil's recoverable energy     enters as q and q p, and by the power of its adjustment
    /// neck          C p                        I q^2/2 + C p^2/2            enters as q and q p
    ///   a valve     C p                        C p^2/2                      likewise: its throttling loss is lost there
    /// ```
    ///
    /// rho is the density over that at zero gauge pressure and w the energy of compression per
    /// volume: exp(p/beta) and beta (exp(p/beta) - 1 - p/beta) with a constant modulus; with
    /// entrained air, integrals over the pressure, of which only rho has a closed form, evaluated
    /// by a fixed Gauss-Legendre rule. Without air a side's volume is its compliance times the
    /// modulus of its chamber, so that a hose counts as the oil of equal compliance; with air it is
    /// the volume of the fluid, and the oil taken up by yielding walls is added.
    ///
    /// Edges, lines and gas pass on volumes: the difference between the densities at which such an
    /// element receives and delivers oil is lost to the rig's account of oil, q times the
    /// difference of both densities, at most p_S/beta of the flow without air. A constant supply
    /// has no content, and the density of side A.
    pub fn ledger<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T]) -> Option<Ledger<T>> {
        let instant = self.instant(state, inputs)?;
        Some(Ledger { oil: self.oil(&instant), energy: self.energy(&instant) })
    }

    fn oil<T: Scalar + From<S>>(&self, now: &Instant<T>) -> [Account<T>; OIL_ACCOUNTS.len()] {
        let one = T::from(1.0);
        let (edges, supply) = (&now.flows.edges, &now.supply);
        let tank_pressure: T = constant(self.supply.tank_pressure);
        let [tank_a, tank_b] = now.sides.map(|side| side.law.density(tank_pressure));
        let [dense_a, dense_b] = now.sides.map(|side| side.density());
        let dense_s = supply.line.density();
        let [into_a, into_b] = now.chamber_flows();
        let [side_a, side_b] = &now.sides;
        let [gas_a, gas_b] = &now.gas;
        let [out_of_a, out_of_b] = now.flows.out_of_chambers();
        let accounts = [
            side_a.oil(into_a),
            side_b.oil(into_b),
            now.lines[0].oil(),
            now.lines[1].oil(),
            gas_a.oil(),
            gas_b.oil(),
            now.necks[0].oil,
            now.necks[1].oil,
            supply.line.oil(supply.line_flow()),
            supply.gas.oil(),
        ];
        let [a, b, c, d, e, f, g, h, i, j] = accounts;
        let rig = Account {
            stored: total(&accounts, |account| account.stored),
            inflow: dense_s * supply.fed
                - tank_a * (edges.a_to_tank + out_of_a)
                - tank_b * (edges.b_to_tank + out_of_b),
            lost: edges.supply_to_a * (dense_s - one)
                + edges.a_to_tank * (one - tank_a)
                + edges.supply_to_b * (dense_s - one)
                + edges.b_to_tank * (one - tank_b)
                + now.lines[0].into_chamber * (one - dense_a)
                + now.lines[1].into_chamber * (one - dense_b)
                + (now.flows.internal + now.turned) * (dense_a - dense_b)
                + out_of_a * (dense_a - tank_a)
                + out_of_b * (dense_b - tank_b)
                + gas_a.taken * (dense_a - one)
                + gas_b.taken * (dense_b - one)
                + supply.gas.inflow * (dense_s - one),
        };
        [a, b, c, d, e, f, g, h, i, j, rig]
    }

    fn energy<T: Scalar + From<S>>(&self, now: &Instant<T>) -> [Account<T>; ENERGY_ACCOUNTS.len()] {
        let zero = T::from(0.0);
        let (state, supply, edges) = (&now.state, &now.supply, &now.flows.edges);
        let ([side_a, side_b], [line_a, line_b]) = (&now.sides, &now.lines);
        let velocity = state.velocity;
        let [area_a, area_b] = self.areas_at(now.joint.position);
        let [into_a, into_b] = now.chamber_flows();
        let tank: T = constant(self.supply.tank_pressure);
        let throttled = edges.supply_to_a * (supply.line.pressure - line_a.port_pressure)
            + edges.a_to_tank * (line_a.port_pressure - tank)
            + edges.supply_to_b * (supply.line.pressure - line_b.port_pressure)
            + edges.b_to_tank * (line_b.port_pressure - tank);
        let [piston, friction, sensor, series, end_stops, load] = self.moving(now);
        let [out_of_a, out_of_b] = now.flows.out_of_chambers();
        let [valve_a, valve_b] = self.through_port_valves(now);
        let leaked = (now.flows.internal - now.flows.cross_port) * (side_a.pressure - side_b.pressure)
            + (out_of_a - valve_a) * (side_a.pressure - tank)
            + (out_of_b - valve_b) * (side_b.pressure - tank);
        let accounts = [
            side_a.energy(into_a, area_a * velocity - now.turned),
            side_b.energy(into_b, now.turned - area_b * velocity),
            line_a.energy(),
            line_b.energy(),
            now.gas[0].energy(),
            now.gas[1].energy(),
            now.necks[0].energy,
            now.necks[1].energy,
            heat(now.gas[0].heat),
            heat(now.gas[1].heat),
            supply.line.energy(supply.line_flow(), zero),
            supply.gas.energy(),
            heat(throttled),
            heat(leaked),
            self.cross_port_account(now),
            heat(valve_a * (side_a.pressure - tank) + valve_b * (side_b.pressure - tank)),
            piston,
            friction,
            sensor,
            series,
            end_stops,
            load,
        ];
        // Only the flows across the rig's border: flow work and compression energy of the oil, the
        // work of the external force, and the work on the ground.
        let carried = side_a.compression() * into_a
            + side_b.compression() * into_b
            + supply.line.compression() * supply.line_flow();
        let drained = edges.a_to_tank + edges.b_to_tank + out_of_a + out_of_b;
        let oil = supply.line.pressure * supply.fed - tank * drained + carried;
        let rig = Account {
            stored: total(&accounts, |account| account.stored),
            inflow: oil + now.external_power - self.on_ground(now) + now.gas[0].work + now.gas[1].work,
            lost: total(&accounts, |account| account.lost),
        };
        let [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v] = accounts;
        [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, rig]
    }

    /// Flows out of both chambers through their relief and check valves, m3/s.
    fn through_port_valves<T: Scalar + From<S>>(&self, now: &Instant<T>) -> [T; 2] {
        let Some(outward) = &self.outward else { return [T::from(0.0); 2] };
        let outward = outward.convert(&mut constant::<S, T>);
        let tank: T = constant(self.supply.tank_pressure);
        outward.through_port_valves([now.state.pressure_a, now.state.pressure_b], tank)
    }

    /// Valve between the chambers: heat of its restrictor, and content of its capacity.
    fn cross_port_account<T: Scalar + From<S>>(&self, now: &Instant<T>) -> Account<T> {
        let (flow, [side_a, side_b]) = (now.flows.cross_port, &now.sides);
        let drop = side_a.pressure - side_b.pressure;
        let Some(capacity) = self.cross_port.and_then(|port| port.capacity) else { return heat(flow * drop) };
        let held = now.state.cross_port_pressure;
        Account {
            stored: T::from(0.5) * constant::<S, T>(capacity) * held.squared(),
            inflow: flow * drop,
            lost: flow * (drop - held),
        }
    }

    /// Piston, friction, sensor, series element, end stops and load.
    fn moving<T: Scalar + From<S>>(&self, now: &Instant<T>) -> [Account<T>; 6] {
        let (zero, half) = (T::from(0.0), T::from(0.5));
        let (state, load) = (&now.state, &now.load);
        let velocity = state.velocity;
        let joint = &now.joint;
        let position = joint.position;
        let forces = self.forces(state, position);
        let pushing = forces.hydraulic + forces.end_stops - forces.friction.force - joint.sensed;
        let friction = self.friction.convert(&mut constant::<S, T>);
        let kinetic = half * constant::<S, T>(self.cylinder.moving_mass) * velocity.squared();
        let [held, _, damped] = self.load.convert(&mut constant::<S, T>).powers(load, &now.ground);
        [
            Account { stored: kinetic, inflow: pushing * velocity, lost: zero },
            Account {
                stored: friction.stored_energy(state.bristle),
                inflow: forces.friction.force * velocity,
                lost: friction.dissipated(velocity, state.bristle),
            },
            Account {
                stored: half * joint.sensed * joint.sensor_deflection,
                inflow: joint.sensed * (velocity - joint.behind_sensor),
                lost: zero,
            },
            self.series_account(now),
            self.end_stop_account(position, velocity, forces.end_stops),
            Account {
                stored: held + self.weight_energy(load),
                inflow: joint.on_load * now.end.velocity + now.external_power - self.on_ground(now),
                lost: damped,
            },
        ]
    }

    /// Power from the load to its ground, W.
    fn on_ground<T: Scalar + From<S>>(&self, now: &Instant<T>) -> T {
        if self.load.moves() {
            let [_, to_ground, _] = self.load.convert(&mut constant::<S, T>).powers(&now.load, &now.ground);
            return to_ground;
        }
        now.joint.on_load * now.end.velocity
    }

    /// Spring, damper, ends and mass, or the oil of a transmission, between the sensor and a load.
    fn series_account<T: Scalar + From<S>>(&self, now: &Instant<T>) -> Account<T> {
        let (zero, half, joint) = (T::from(0.0), T::from(0.5), &now.joint);
        let inflow = joint.sensed * joint.behind_sensor - joint.on_load * now.end.velocity;
        match &self.series {
            None => Account { stored: zero, inflow: zero, lost: zero },
            Some(MovingSeries::Spring(spring)) => {
                let spring = spring.convert(&mut constant::<S, T>);
                let Motion { position: deflection, velocity: rate } = joint.spring;
                let kinetic = half * spring.mass.unwrap_or(zero) * joint.behind_sensor.squared();
                let stored = spring.stored_energy(deflection) + kinetic;
                Account { stored, inflow, lost: spring.dissipated(deflection, rate) }
            }
            Some(MovingSeries::Oil(column)) => {
                let column = column.convert(&mut constant::<S, T>);
                let behind = plugs(&now.columns).map(|(_, deflection)| deflection);
                let forces = column.forces(joint.sensed, behind);
                let springs = forces.iter().enumerate();
                let elastic = springs.fold(zero, |sum, (plugs, force)| {
                    sum + half * force.squared() / column.stiffness_behind(plugs)
                });
                let squares = plugs(&now.columns).fold(zero, |sum, (velocity, _)| sum + velocity.squared());
                let stored = elastic + half * column.mass * squares;
                Account { stored, inflow, lost: column.damping * squares }
            }
        }
    }

    fn end_stop_account<T: Scalar + From<S>>(&self, position: T, velocity: T, force: T) -> Account<T> {
        let zero = T::from(0.0);
        let Some(contact) = self.cylinder.end_stops else {
            return Account { stored: zero, inflow: zero, lost: zero };
        };
        let contact = contact.convert(&mut constant::<S, T>);
        let [from_a, to_b] = self.cylinder.stroke.convert(&mut constant::<S, T>).distances(position);
        let (before, beyond) = (-from_a, -to_b);
        Account {
            stored: contact.stored_energy(before) + contact.stored_energy(beyond),
            inflow: -force * velocity,
            lost: contact.dissipated(before, -velocity) + contact.dissipated(beyond, velocity),
        }
    }
}
