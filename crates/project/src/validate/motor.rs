//! Motor in place of the cylinder: features that phea does not yet support with one.

use super::Check;
use crate::{DeclaredActuator, InputSignal, MotionShape, Project, Scenario};

pub(super) fn motor(project: &Project, actuator: &DeclaredActuator, check: &mut Check<'_, '_>) {
    let absent = [
        (actuator.series.is_some(), "series", "a spring or transmission between force sensor and load"),
        (project.sizing.is_some(), "sizing", "the sizing of a hose"),
        (project.bench.friction.is_some(), "bench.friction", "a test of friction"),
    ];
    for (is_there, path, what) in absent {
        if is_there {
            let message = format!("{what} is for a [cylinder]: it is not supported with a [motor] yet");
            check.error_with_help(path, message, format!("remove [{path}]"));
        }
    }
    for (index, scenario) in project.scenarios.iter().enumerate() {
        files(scenario, &format!("scenario[{index}]"), check);
    }
}

/// Rejects files, whose columns have the names and units of linear motion.
fn files(scenario: &Scenario, path: &str, check: &mut Check<'_, '_>) {
    let message = "files of a rig with a [motor] are not read yet: their columns say force and position";
    for key in keys_of_files(scenario) {
        check.error_with_help(&format!("{path}.{key}"), message, "state the values in the project file");
    }
}

/// Keys of a scenario that name files.
pub(super) fn keys_of_files(scenario: &Scenario) -> impl Iterator<Item = &'static str> {
    let has_file = |all: &[InputSignal]| all.iter().any(|signal| matches!(signal, InputSignal::File { .. }));
    let motion = scenario.load_motion.as_ref();
    let keys = [
        ("reference", has_file(&scenario.reference)),
        ("external_force", has_file(&scenario.external_force)),
        ("load_motion", motion.is_some_and(|motion| matches!(motion.shape, MotionShape::File { .. }))),
        ("start", scenario.start.as_ref().is_some_and(|start| start.file.is_some())),
        ("measured", !scenario.measured.is_empty()),
    ];
    keys.into_iter().filter(|(_, is_there)| *is_there).map(|(key, _)| key)
}
