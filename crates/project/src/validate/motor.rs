//! A motor in place of the cylinder: what it needs, and what phea does not yet do with one.

use super::Check;
use crate::{DeclaredActuator, MotionShape, Project, Scenario, Signal};

pub(super) fn motor(project: &Project, actuator: &DeclaredActuator, check: &mut Check<'_, '_>) {
    let Some(motor) = &actuator.motor else { return };
    if motor.end_stops.is_some() && motor.stroke.is_none() && !check.declared("motor.stroke") {
        let message = "a motor without `stroke` turns on: it has no ends to stop at";
        check.error_with_help("motor.end_stops", message, "state the `stroke`, or remove [motor.end_stops]");
    }
    let absent = [
        (actuator.series.is_some(), "series", "a spring or transmission between force sensor and load"),
        (project.sizing.is_some(), "sizing", "the sizing of a hose"),
        (project.bench.friction.is_some(), "bench.friction", "a test of friction"),
    ];
    for (is_there, path, what) in absent {
        if is_there {
            let message = format!("{what} is for a [cylinder]: there is none for a [motor] yet");
            check.error_with_help(path, message, format!("remove [{path}]"));
        }
    }
    for (index, scenario) in project.scenarios.iter().enumerate() {
        files(scenario, &format!("scenario[{index}]"), check);
    }
}

/// Columns of files have the names and units of linear motion.
fn files(scenario: &Scenario, path: &str, check: &mut Check<'_, '_>) {
    let mut refuse = |key: &str| {
        let message = "files of a rig with a [motor] are not read yet: their columns say force and position";
        check.error_with_help(&format!("{path}.{key}"), message, "state the values in the project file");
    };
    let is_file = |signal: &Signal| matches!(signal, Signal::File { .. });
    for (key, signals) in [("reference", &scenario.reference), ("external_force", &scenario.external_force)] {
        if signals.iter().any(is_file) {
            refuse(key);
        }
    }
    if scenario.load_motion.as_ref().is_some_and(|motion| matches!(motion.shape, MotionShape::File { .. })) {
        refuse("load_motion");
    }
    if scenario.start.as_ref().is_some_and(|start| start.file.is_some()) {
        refuse("start");
    }
    if !scenario.measured.is_empty() {
        refuse("measured");
    }
}
