//! The forces that a rig reaches at rest, and those that its sensor withstands.

use phea_hydraulics::actuator::Components;
use phea_hydraulics::servovalve::Supply;

use crate::project::{DeclaredActuator, Project};
use crate::rig::{Numbers, components};

/// Forces that a rig reaches, and those that its sensor withstands.
pub(crate) struct ForceLimits<'a> {
    pub(super) project: &'a Project,
    /// Pa and N: the supply as declared and, where it is uncertain, the lowest of the family.
    pub(super) stall: Vec<(f64, [f64; 2])>,
    /// N, to either side.
    pub(super) capacity: Option<f64>,
}

/// What limits a force at rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForceLimit {
    /// The supply pressure on the piston.
    Supply,
    /// The declared capacity of the force sensor.
    Sensor,
}

impl<'a> ForceLimits<'a> {
    pub(crate) fn of(project: &'a Project, actuator: &'a DeclaredActuator) -> ForceLimits<'a> {
        let Components { cylinder, supply, .. } = components(actuator, &Numbers::declared());
        let range = project.uncertainty.iter().find(|one| one.name == "supply.pressure");
        let lowest = range.map(|range| range.minimum).filter(|lowest| *lowest < supply.pressure);
        let pressures = std::iter::once(supply.pressure).chain(lowest);
        let stall = |pressure: f64| {
            let supply = Supply { pressure, ..supply };
            (pressure, cylinder.stall_forces(&supply))
        };
        let capacity = actuator.force_sensor.capacity;
        ForceLimits { project, stall: pressures.map(stall).collect(), capacity }
    }

    /// The greatest force in a direction, N with its sign, at every supply pressure of the family,
    /// and what limits it.
    pub(crate) fn greatest(&self, direction: f64) -> (f64, ForceLimit) {
        let sign = direction.signum();
        let side = if sign < 0.0 { 0 } else { 1 };
        let stall = self.stall.iter().map(|(_, stall)| sign * stall[side]).fold(f64::INFINITY, f64::min);
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

    /// A_A p_S - A_B p_T one way and A_A p_T - A_B p_S the other, at the lowest supply pressure, or
    /// the capacity of the sensor where that is less.
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
