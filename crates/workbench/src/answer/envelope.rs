//! The keys of every answer in front of those of the command.

use super::chosen_lines::{ChosenLinesAnswer, body_of_lines};
use super::recorded::{RecordedAnswer, body_in_use};
use super::words::words;
use super::{Answer, Body, Object};
use crate::project::Loaded;
use crate::quantity::MotionKind;

/// Version of the JSON layout.
pub(crate) const SCHEMA: u32 = 1;
/// Version of the program.
pub(crate) const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Keys of every answer about a project.
#[derive(Answer)]
pub(super) struct Envelope {
    /// Version of the layout of answers.
    schema: u32,
    /// Version of phea.
    version: &'static str,
    /// Name of the command.
    command: &'static str,
    /// Title of the project.
    title: String,
    /// SHA-256 of the bytes of the project file, before settings.
    project_sha256: String,
    /// Settings that replaced values of the file, each `path=value`.
    settings: Vec<String>,
    /// Catalogue files in addition to the built-in catalogue.
    catalogue_files: Vec<String>,
    /// Motion of the actuator, only of a rig with a motor: its torques are in N m, its angles in
    /// rad, and the names of such quantities end in those units.
    #[answer(optional)]
    motion: Option<TurningMotion>,
    /// Values identified from recordings, which replace those of the file.
    #[answer(optional)]
    identified: Option<RecordedAnswer>,
    /// Model chosen for the lines, where the file states none.
    #[answer(optional)]
    line_model: Option<ChosenLinesAnswer>,
}

/// Motion that differs from that of a cylinder.
enum TurningMotion {
    Rotary,
}

words! {
    /// Motion of a motor.
    TurningMotion { Rotary => "rotary" }
}

/// The keys of the answer of this command in front of its own.
pub(crate) fn envelope(command: &'static str, loaded: &Loaded) -> Object {
    let motion: MotionKind = loaded.project.motion();
    let envelope = Envelope {
        schema: SCHEMA,
        version: VERSION,
        command,
        title: loaded.project.title.clone(),
        project_sha256: loaded.sha256.clone(),
        settings: loaded.settings.clone(),
        catalogue_files: loaded.catalogue_files.clone(),
        motion: motion.is_rotary().then_some(TurningMotion::Rotary),
        identified: loaded.recorded.as_ref().map(body_in_use),
        line_model: loaded.lines.as_ref().map(|lines| body_of_lines(lines, motion)),
    };
    envelope.into_object()
}
