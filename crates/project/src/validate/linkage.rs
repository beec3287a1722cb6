//! Linkage with the rest of a project: features that phea does not yet support with one.

use super::Check;
use super::motor::keys_of_files;
use crate::{DeclaredActuator, Load, Project, Scenario};

pub(super) fn linkage(project: &Project, actuator: &DeclaredActuator, check: &mut Check<'_, '_>) {
    let Some(linkage) = &actuator.linkage else { return };
    if actuator.motor.is_some() {
        let message =
            "a linkage turns the thrust of a [cylinder] into a torque, and a [motor] has a torque of its own";
        return check.error_with_help("linkage", message, "remove [linkage]");
    }
    if actuator.load == Load::Prescribed && check.reader.root_entry("load").is_none() {
        let message = "[linkage] without a [load]: its joint moves as [[scenario]] `load_motion` says, in degrees, and stands still otherwise";
        check.warning("linkage", message);
    }
    if linkage.weight.is_some() && actuator.load == Load::Prescribed && !check.is_unclear("load") {
        let message =
            "a load with a prescribed motion follows it whatever its weight: `weight` has no effect";
        check.warning("linkage.weight", message);
    }
    not_yet(project, check);
    for (index, scenario) in project.scenarios.iter().enumerate() {
        files(scenario, &format!("scenario[{index}]"), check);
    }
    certain(project, check);
}

/// Rejects parts that assume a load which moves with the rod.
fn not_yet(project: &Project, check: &mut Check<'_, '_>) {
    let impedance = project.controller.as_ref().is_some_and(|controller| controller.impedance.is_some());
    let absent = [
        (impedance, "controller.impedance", "a virtual impedance"),
        (project.bench.friction.is_some(), "bench.friction", "a test of friction"),
    ];
    for (is_there, path, what) in absent {
        if is_there {
            let message = format!(
                "{what} is for a load that moves with the rod: it is not supported with a [linkage] yet"
            );
            check.error_with_help(path, message, format!("remove [{path}] or [linkage]"));
        }
    }
    if project.operating_point.velocity.is_some_and(|velocity| velocity != 0.0) {
        let message = "in steady motion the lever arm of a [linkage] changes all the time: no linear plant describes it";
        let help = "take the linear plant at standstill: remove `velocity`";
        check.error_with_help("operating_point.velocity", message, help);
    }
}

/// Rejects files, whose columns have the names and units of a load that moves with the rod.
fn files(scenario: &Scenario, path: &str, check: &mut Check<'_, '_>) {
    let message =
        "with a [linkage] this file is not read yet: its columns say force and position, and the load turns";
    let of_load = ["external_force", "load_motion", "start"];
    for key in keys_of_files(scenario).filter(|key| of_load.contains(key)) {
        check.error_with_help(&format!("{path}.{key}"), message, "state the values in the project file");
    }
}

/// Rejects uncertain numbers of a linkage: its polynomial is found before any number of a family.
fn certain(project: &Project, check: &mut Check<'_, '_>) {
    let is_weight = |name: &str| ["linkage.weight.mass", "linkage.weight.centre_distance"].contains(&name);
    let is_of_linkage =
        |name: &str| name.starts_with("linkage.") && !is_weight(name) || name == "cylinder.stroke";
    let mut refuse = |place: String, name: &str| {
        let message = format!(
            "`{name}` cannot be uncertain with a [linkage]: what its lengths make of the stroke is found once, for all plants"
        );
        let help = "vary it in [campaign] or as an [[alternative]]";
        check.error_with_help(&place, message, help);
    };
    for one in project.uncertainty.iter().filter(|one| is_of_linkage(&one.name)) {
        refuse(format!("uncertainty.{}", one.name), &one.name);
    }
    for (index, direction) in project.directions.iter().enumerate() {
        for (name, _) in direction.changes.numbers.iter().filter(|(name, _)| is_of_linkage(name)) {
            refuse(format!("uncertainty_direction[{index}]"), name);
        }
    }
    let cases = project.family.iter().flat_map(|family| &family.cases);
    for (name, _) in cases.flat_map(|case| &case.parameters).filter(|(name, _)| is_of_linkage(name)) {
        refuse("family.cases".to_string(), name);
    }
}
