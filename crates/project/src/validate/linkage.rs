//! Linkage: its closure over the stroke, and features that phea does not yet support with one.

use super::Check;
use super::motor::keys_of_files;
use crate::{DeclaredActuator, DeclaredLinkage, LinkageKind, Load, Project, Scenario};
use phea_hydraulics::linkage::LinkageError;
use phea_quantity::{self as quantity, LENGTH};

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
    closes(linkage, actuator.cylinder.stroke, check);
    not_yet(project, check);
    for (index, scenario) in project.scenarios.iter().enumerate() {
        files(scenario, &format!("scenario[{index}]"), check);
    }
    certain(project, check);
}

/// Reports a linkage that cannot exist.
fn closes(linkage: &DeclaredLinkage, stroke: f64, check: &mut Check<'_, '_>) {
    let keys = ["cylinder_pivot", "rod_pivot", "retracted_length", "fixed_link", "input_link", "coupler"];
    let more = ["output_link", "extensions", "angles", "tolerance", "angle_offset", "input_angle", "kind"];
    let lacks = |key: &&str| check.refused(&format!("linkage.{key}"));
    if stroke <= 0.0 || check.refused("cylinder.stroke") || keys.iter().chain(&more).any(lacks) {
        return;
    }
    if let LinkageKind::Table { extensions, angles, .. } = &linkage.kind {
        if extensions.is_empty() || angles.is_empty() {
            return;
        }
        if extensions.len() != angles.len() {
            let message = format!(
                "`angles` has {} values and `extensions` {}: each angle belongs to one extension",
                angles.len(),
                extensions.len()
            );
            return check.error_with_help("linkage.angles", message, "state the same number of both");
        }
    } else if !check.declared("linkage.retracted_length") {
        return;
    }
    if let Err(error) = linkage.reduced(stroke) {
        let (key, message, help) = refusal(&error);
        check.error_with_help(&format!("linkage.{key}"), message, help);
    }
}

/// Key, reason and remedy of an error.
fn refusal(error: &LinkageError) -> (&'static str, String, String) {
    let mm = |length: f64| quantity::display(length, &LENGTH, 4);
    match *error {
        LinkageError::NoTriangle { position, length, possible: [least, most] } => (
            "retracted_length",
            format!(
                "the linkage cannot close: at a position of {} its pivots are {} apart, and about the joint only {} to {} are possible",
                mm(position),
                mm(length),
                mm(least),
                mm(most)
            ),
            "change `retracted_length`, `cylinder_pivot` or `rod_pivot`, or shorten the `stroke` (1 % beyond either end counts)"
                .to_string(),
        ),
        LinkageError::NoFourBar { position } => (
            "coupler",
            format!(
                "the linkage cannot close: at a position of {} `coupler` and `output_link` do not reach each other",
                mm(position)
            ),
            "change the lengths of the links or `input_angle`, or shorten the `stroke` (1 % beyond either end counts)".to_string(),
        ),
        LinkageError::DeadPoint { position } => (
            "kind",
            format!(
                "the linkage comes to a dead point at a position of {}: there the force has no lever arm about the joint, or the joint does not turn",
                mm(position)
            ),
            "change its lengths, or shorten the `stroke`, so that the least lever arm is more than 2 % of the greatest".to_string(),
        ),
        LinkageError::NotSmooth { error } => (
            "kind",
            format!("near a dead point the lever arm changes too fast: one polynomial leaves an error of {}", mm(error)),
            "change its lengths, or shorten the `stroke`, to stay away from the dead point".to_string(),
        ),
        _ => refusal_of_table(error),
    }
}

fn refusal_of_table(error: &LinkageError) -> (&'static str, String, String) {
    let mm = |length: f64| quantity::display(length, &LENGTH, 4);
    match *error {
        LinkageError::FewRows { rows } => (
            "extensions",
            format!("a table of {rows} rows says nothing between them"),
            "state two rows or more".to_string(),
        ),
        LinkageError::TableOrder { row } => (
            "angles",
            format!("row {row} of the table does not increase: the angle grows with the extension"),
            "order the rows by extension, and count the angle in the other sense if it falls".to_string(),
        ),
        LinkageError::TableRough { residual, tolerance, degree } => (
            "tolerance",
            format!(
                "the table is not smooth: a polynomial of degree {degree} passes a row at {}, and `tolerance` permits {}",
                mm(residual),
                mm(tolerance)
            ),
            "correct the row, measure more rows, or permit more".to_string(),
        ),
        LinkageError::TableShort { from, to } => (
            "extensions",
            format!("the table extends from {} to {}, and not over the stroke", mm(from), mm(to)),
            "state the angles from position 0 to the `stroke`".to_string(),
        ),
        _ => ("kind", error.to_string(), "change its lengths, or shorten the `stroke`".to_string()),
    }
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
