//! What recordings gave in place of what a project declares, for programs.

use phea_engineering::identify::COVERAGE;

use super::Object;
use crate::project::{FromRecordings, KeptReason};

/// The files, what is from them, what stays as declared, and the family.
pub(crate) fn body_in_use(recorded: &FromRecordings) -> Object {
    let family = recorded.family.as_ref().map(|family| {
        Object::new()
            .with("coverage", COVERAGE)
            .with("deviations", family.deviations)
            .each("effects", &family.effects, |effect| *effect)
            .with("left_out", family.left_out)
            .with("effect_left_out", family.effect_left_out)
    });
    Object::new()
        .with("project_file_sha256", recorded.project_sha256.as_str())
        .each("files", &recorded.files, |file| {
            Object::new().with("file", file.path.as_str()).with("sha256", file.sha256.as_str())
        })
        .each("values", &recorded.numbers, |one| {
            Object::new()
                .with("path", one.path.as_str())
                .with("value", one.value)
                .with("unit", one.unit)
                .with("confidence_95", one.interval.to_vec())
                .with("declared", one.declared)
        })
        .each("kept", &recorded.kept, |one| {
            Object::new().with("path", one.path.as_str()).with("reason", kept_because(one.reason))
        })
        .with("tare_pressure_pa", recorded.tare_pressures[0])
        .with("declared_tare_pressure_pa", recorded.tare_pressures[1])
        .maybe("family", family)
}

/// Reason for which a number stays as declared.
pub(crate) fn kept_because(reason: KeptReason) -> &'static str {
    match reason {
        KeptReason::NotIdentifiable => "the recordings do not determine it",
        KeptReason::MayVanish => "the recordings cannot distinguish it from zero",
    }
}
