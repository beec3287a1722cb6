//! Forces that a rig reaches at rest, and forces that its sensor withstands.

use phea_hydraulics::actuator::Components;
use phea_hydraulics::operating_point::{Balance, Steady, hydraulic_force};
use phea_hydraulics::servovalve::Supply;

use super::TimeRequirement;
use crate::project::{DeclaredActuator, Project};
use crate::rig::components;
use crate::setup::Setup;

/// Forces that a rig reaches, and forces that its sensor withstands.
pub(crate) struct ForceLimits {
    /// Supply pressures, Pa, with stall forces, N: the supply as declared and, if it is uncertain,
    /// the lowest of the family.
    pub(super) stall: Vec<(f64, [f64; 2])>,
    /// Relief valves that open before the piston stalls.
    relieved: Option<ReliefLimit>,
    /// Capacity of the force sensor in either direction, N.
    pub(super) capacity: Option<f64>,
}

/// Relief valves that open within the pressure of the supply.
struct ReliefLimit {
    /// Chamber pressures at which the valve of the pushing chamber opens, retracting and extending,
    /// Pa; infinite without such a valve.
    opens_at: [f64; 2],
    /// Forces that the fully open servovalve holds against these valves, N.
    forces: [f64; 2],
}

impl ReliefLimit {
    fn of(components: &Components) -> Option<ReliefLimit> {
        let Components { outward, supply, valve, .. } = components;
        let opens_at = outward.port_valves.map(|valves| {
            let relief = valves.and_then(|valves| valves.relief);
            relief.map_or(f64::INFINITY, |relief| supply.tank_pressure + relief.cracking_pressure)
        });
        let [opens_a, opens_b] = opens_at;
        if opens_a.min(opens_b) >= supply.pressure {
            return None;
        }
        let balance = Balance::at(components, 0.0);
        let forces = [-1.0, 1.0].map(|direction| {
            let settled = balance.settle(Steady::Command(direction * valve.nominal_voltage));
            hydraulic_force(balance.areas, settled.pressures)
        });
        Some(ReliefLimit { opens_at: [opens_b, opens_a], forces })
    }
}

/// A required step that a rig does not reach, or does not survive.
#[derive(Clone, Debug, PartialEq)]
pub struct BeyondReach {
    /// Number of the specification, from 1.
    pub number: usize,
    /// End of the step.
    pub end: StepEnd,
    /// Force at this end, N.
    pub force: f64,
    /// Exceeded limit.
    pub exceeded: ExceededForce,
}

/// End of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepEnd {
    /// Force before the step.
    Begin,
    /// Force after the step.
    End,
}

impl StepEnd {
    /// Key of a specification that states the end.
    pub fn key(self) -> &'static str {
        match self {
            StepEnd::Begin => "initial_force",
            StepEnd::End => "amplitude",
        }
    }
}

/// Limit on the force at rest that a force exceeds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExceededForce {
    /// Kind of the limit.
    pub limit: RestLimit,
    /// Greatest force in its direction that the rig reaches and its sensor withstands, N.
    pub greatest: f64,
}

/// A limit on the force at rest, with its number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RestLimit {
    /// Stall force of the piston, N, at this supply pressure, Pa.
    Stall {
        /// Supply pressure, Pa.
        pressure: f64,
        /// Stall force, N.
        force: f64,
    },
    /// Force at which the fully open servovalve and a relief valve of a chamber balance, N.
    Relief {
        /// Chamber pressure at which the relief valve opens, Pa.
        opens_at: f64,
        /// Force that is held against it, N.
        force: f64,
    },
    /// Capacity of the force sensor, N.
    Capacity(f64),
}

/// Ends of required steps that are beyond the stall force of the piston, or beyond the capacity of
/// the force sensor.
pub(crate) fn steps_beyond(setup: &Setup<'_>, required: &[TimeRequirement]) -> Vec<BeyondReach> {
    let (Some(actuator), Ok(rig)) = (&setup.project.actuator, setup.rig()) else { return vec![] };
    let limits = ForceLimits::of(setup.project, actuator);
    let mut found = Vec::new();
    for TimeRequirement { number, steps, .. } in required {
        let from_n = steps.initial_force_n.unwrap_or(rig.point.hydraulic_force);
        let to_n = steps.amplitude_n.map(|amplitude_n| from_n + amplitude_n);
        let begins = steps.initial_force_n.map(|from_n| (StepEnd::Begin, from_n));
        for (end, force) in begins.into_iter().chain(to_n.map(|to_n| (StepEnd::End, to_n))) {
            let own = |exceeded| BeyondReach { number: *number, end, force, exceeded };
            found.extend(limits.beyond(force).into_iter().map(own));
        }
    }
    found
}

/// Limitation of a force at rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForceLimit {
    /// The supply pressure on the piston, as far as relief valves of its chambers admit it.
    Supply,
    /// The declared capacity of the force sensor.
    Sensor,
}

impl ForceLimits {
    pub(crate) fn of(project: &Project, actuator: &DeclaredActuator) -> ForceLimits {
        let components = components(actuator, actuator);
        let Components { cylinder, supply, .. } = components;
        let range = project.uncertainty.iter().find(|one| one.name == "supply.pressure");
        let lowest = range.map(|range| range.minimum).filter(|lowest| *lowest < supply.pressure);
        let pressures = std::iter::once(supply.pressure).chain(lowest);
        let stall = |pressure: f64| {
            let supply = Supply { pressure, ..supply };
            (pressure, cylinder.stall_forces(&supply))
        };
        let capacity = actuator.force_sensor.capacity;
        let relieved = ReliefLimit::of(&components);
        ForceLimits { stall: pressures.map(stall).collect(), relieved, capacity }
    }

    /// Limits that a force, N, exceeds.
    pub(crate) fn beyond(&self, force_n: f64) -> Vec<ExceededForce> {
        let (sign, side) = if force_n < 0.0 { (-1.0, 0) } else { (1.0, 1) };
        let greatest = self.greatest(force_n).0;
        let exceeds = |(_, stall): &&(f64, [f64; 2])| sign * force_n > sign * stall[side];
        // the declared supply comes first: the lowest of the family adds nothing to it
        let stall = self.stall.iter().find(exceeds);
        let stall =
            stall.map(|(pressure, stall)| RestLimit::Stall { pressure: *pressure, force: stall[side] });
        let relieved = self.relieved.as_ref().filter(|relief| sign * force_n > sign * relief.forces[side]);
        let relieved = relieved.filter(|_| stall.is_none());
        let relieved =
            relieved.map(|of| RestLimit::Relief { opens_at: of.opens_at[side], force: of.forces[side] });
        let capacity = self.capacity.filter(|capacity| sign * force_n > *capacity).map(RestLimit::Capacity);
        stall
            .into_iter()
            .chain(relieved)
            .chain(capacity)
            .map(|limit| ExceededForce { limit, greatest })
            .collect()
    }

    /// Greatest signed force in a direction, N, at every supply pressure of the family, and its
    /// limitation.
    pub(crate) fn greatest(&self, direction: f64) -> (f64, ForceLimit) {
        let sign = direction.signum();
        let side = if sign < 0.0 { 0 } else { 1 };
        let relieved = self.relieved.as_ref().map_or(f64::INFINITY, |relief| sign * relief.forces[side]);
        let stall = self.stall.iter().map(|(_, stall)| sign * stall[side]).fold(relieved, f64::min);
        match self.capacity.filter(|capacity| *capacity < stall) {
            Some(capacity) => (sign * capacity, ForceLimit::Sensor),
            None => (sign * stall, ForceLimit::Supply),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use phea_project::source::Memory;

    use super::*;

    /// Greatest force A_A p_S - A_B p_T in one direction and A_A p_T - A_B p_S in the other, at the
    /// lowest supply pressure, or the capacity of the sensor if that is less.
    // ORIGIN: analytic, a piston of 50 mm with a rod of 22 mm to one side
    #[test]
    fn the_greatest_force_is_that_of_the_lowest_supply_or_of_the_sensor() {
        let rods = ["rod_diameter = \"22 mm\"", "rod_diameters = [\"0 mm\", \"22 mm\"]"];
        let text = include_str!("../../../../examples/ybitu/hose.toml").replace(rods[0], rods[1]);
        let of = |uncertain: &str, capacity: &str, direction: f64| {
            let source = Memory::default().with("rig.toml", text.as_str());
            let settings = [
                "supply.pressure=\"100 bar\"",
                "supply.tank_pressure=\"5 bar\"",
                &format!("uncertainty={{ {uncertain} }}"),
                &format!("force_sensor.capacity=\"{capacity}\""),
            ];
            let read = phea_project::read(&source, "rig.toml", &settings.map(str::to_string), &[]);
            let project = read.unwrap_or_else(|report| panic!("{report}")).project;
            ForceLimits::of(&project, project.actuator.as_ref().unwrap()).greatest(direction)
        };
        let [area_a, area_b] = [0.05 * 0.05, 0.05 * 0.05 - 0.022 * 0.022].map(|square| 0.25 * PI * square);
        let near = |(found, limit): (f64, ForceLimit), expected: f64, by: ForceLimit| {
            assert!((found - expected).abs() < 1e-6 && limit == by, "{found} {expected} {limit:?}");
        };
        let [most, least, tank] = [100e5, 80e5, 5e5];
        near(of("", "1 MN", 1.0), area_a * most - area_b * tank, ForceLimit::Supply);
        near(of("", "1 MN", -1.0), area_a * tank - area_b * most, ForceLimit::Supply);
        let falls = "\"supply.pressure\" = { nominal = \"100 bar\", minimum = \"80 bar\", maximum = \"110 bar\", points = 2 }";
        near(of(falls, "1 MN", 1.0), area_a * least - area_b * tank, ForceLimit::Supply);
        near(of("", "6 kN", 1.0), 6e3, ForceLimit::Sensor);
        near(of("", "6 kN", -1.0), -6e3, ForceLimit::Sensor);
    }
}
