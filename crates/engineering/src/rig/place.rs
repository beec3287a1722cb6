//! The point about which the linear model is taken: the operating point of the project, over any
//! scalar.

use phea_dynamics::scalar::Scalar;
use phea_hydraulics::operating_point::{Steady, SteadyLoad};
use phea_hydraulics::stroke::ActuatorStroke;

use super::numbers::Numbers;
use crate::project::{self, Project};

/// The position in m (in rad, of a motor) and the condition for the pressures. At null the piston is blocked; with a
/// command it moves, without load pressure unless one is declared, thesis (4.18); with a velocity
/// there is no load unless one is declared.
pub fn place<S: Scalar>(
    project: &Project,
    stroke: ActuatorStroke<S>,
    numbers: &Numbers<'_, S>,
) -> (S, Steady<S>) {
    let declared = project.resolved_operating_point();
    let numbers = numbers.within("operating_point");
    let at = |name: &str, value: Option<f64>| value.map(|value| numbers.at(name, value));
    let position = at("position", declared.position).unwrap_or(stroke.middle());
    let project::DeclaredOperatingPoint { load_pressure, load_force, velocity, command, .. } = declared;
    let pressure = at("load_pressure", load_pressure);
    let force = at("load_force", load_force);
    let none = S::from(0.0);
    let load = pressure.map(SteadyLoad::Pressure).or(force.map(SteadyLoad::Force));
    let steady = match (command, pressure) {
        (Some(command), Some(pressure)) => Steady::Matched(S::from(command), pressure),
        (Some(command), None) if command != 0.0 => Steady::Matched(S::from(command), none),
        _ if load.is_none() && velocity.is_none() => Steady::Command(none),
        _ => Steady::Moving {
            velocity: at("velocity", velocity).unwrap_or(none),
            load: load.unwrap_or(SteadyLoad::Force(none)),
        },
    };
    (position, steady)
}
