//! Ideal limits of parts as in textbooks: the remaining rig must be valid.

use super::Check;
use crate::{Component, DeclaredActuator, Project, ValveCoefficients};

/// Checks a line, a leakage or a stiffness of zero.
pub(super) fn limits(project: &Project, actuator: &DeclaredActuator, check: &mut Check<'_, '_>) {
    valve_on_chamber(actuator, check);
    shut_valve(project, actuator, check);
    free_mass(project, actuator, check);
}

/// Rejects a chamber that is empty with the piston at its end, since it has no pressure.
fn valve_on_chamber(actuator: &DeclaredActuator, check: &mut Check<'_, '_>) {
    let (one, both, part) = match &actuator.motor {
        Some(motor) => (motor.dead_volume, motor.dead_volumes, "motor"),
        None => (actuator.cylinder.dead_volume, actuator.cylinder.dead_volumes, "cylinder"),
    };
    let dead = both.unwrap_or([one.unwrap_or(0.0); 2]);
    for (side, (line, dead)) in
        ["a", "b"].into_iter().zip([&actuator.line.a, &actuator.line.b].into_iter().zip(dead))
    {
        let Component::Volume(volume) = &line.component else { continue };
        let is_empty = volume.volume <= 0.0 && dead <= 0.0;
        if !is_empty {
            continue;
        }
        let own = format!("line.{side}.volume");
        let path = if check.declared(&own) { own } else { "line.volume".to_string() };
        if check.declared(&path) {
            let message = "without the volume of a line a chamber is empty where the piston is at its end, and has no pressure there";
            let help = format!("state the oil that is left there, such as {part}.dead_volume = \"10 mL\"");
            check.error_with_help(&path, message, help);
        }
        return;
    }
}

/// Edges that are shut at null leave the chamber pressures undetermined, unless all are shut: an
/// ideal valve is the limit of equal leakage.
fn shut_valve(project: &Project, actuator: &DeclaredActuator, check: &mut Check<'_, '_>) {
    let ValveCoefficients::Edges { edges, .. } = &actuator.valve.leakage else { return };
    let is_shut = |edge: &f64| *edge <= 0.0;
    let is_moved = project.uncertainty.iter().any(|one| one.name.starts_with("valve.leakage_coefficients"));
    let is_ideal = edges.to_array().iter().all(|edge| *edge == 0.0) && !is_moved;
    if is_ideal || !edges.to_array().iter().any(is_shut) {
        return;
    }
    let message =
        "an edge without leakage is shut at null, where any pressure of the chamber is an equilibrium";
    let help = "state four zeros for an ideal valve, whose pressures are those of equal leakage that vanishes, or small coefficients: 1e-12 m3/(s.Pa^0.5) is a thousandth of an ordinary edge";
    check.error_with_help("valve.leakage_coefficients", message, help);
}

/// Rejects a mass without stiffness, which takes no force at rest.
fn free_mass(project: &Project, actuator: &DeclaredActuator, check: &mut Check<'_, '_>) {
    if !project.has_free_load() {
        return;
    }
    let point = project.resolved_operating_point();
    let moves = point.velocity.is_some_and(|velocity| velocity != 0.0) || point.command.is_some();
    let holds = point.load_force.is_some_and(|force| force != 0.0);
    if holds && !moves {
        let message = "a load without stiffness holds no force at rest: it would be accelerated";
        let help = "state `load_force = 0`, or a `load.stiffness`";
        check.error_with_help("operating_point.load_force", message, help);
    }
    let moving_line = [&actuator.line.a, &actuator.line.b].into_iter().any(|line| !line.motion.is_lumped());
    if moving_line {
        let message = "a load without stiffness is not computed behind lines in motion: the plant has no polynomials whose common factor could be left out";
        let help = "state `line.model = \"lumped\"`, or a small `load.stiffness`";
        check.error_with_help("load.stiffness", message, help);
    }
}
