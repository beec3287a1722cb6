//! What a command answers: a text for people, one JSON object for programs, and files.
//!
//! Each command has one typed output; this module gives all of them the same envelope and the same
//! treatment of numbers that do not exist.

mod number;
mod object;
mod pictures;
mod recorded;

use serde::Serialize;

use crate::quantity::print_bare;
pub use crate::quantity::significant;
pub use number::Number;
pub(crate) use object::{Json, Object};
pub(crate) use phea_engineering::csv::{Csv, quoted};
pub use phea_engineering::number_table::{NumberTable, TableFormat};

pub use crate::source::OutputFile;
pub use pictures::picture_of;
pub(crate) use pictures::{part_files, picture_files};
pub(crate) use recorded::body_in_use;

use crate::project::Loaded;

/// Version of the JSON layout.
pub(crate) const SCHEMA: u32 = 1;

/// The answer of a command, ready to be printed and written by a shell.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// Tables and short sentences for people.
    pub text: String,
    /// One JSON object.
    pub json: String,
    /// Files for the output folder; the PNG of a drawing, which [`picture_of`] makes, is written
    /// with it.
    pub files: Vec<OutputFile>,
    /// Whether the answer is yes; a no ends the command with status 1.
    pub affirmative: bool,
}

/// The keys of every JSON object in addition to those of the command.
#[derive(Clone, Debug, Serialize)]
struct Envelope<'a, Body> {
    schema: u32,
    version: &'static str,
    command: &'static str,
    title: &'a str,
    project_sha256: &'a str,
    settings: &'a [String],
    catalogue_files: &'a [String],
    /// Of a rig that turns: its torques are in N m and its angles in rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    motion: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    identified: Option<Object>,
    #[serde(flatten)]
    body: Body,
}

/// The JSON object of a command on a project.
pub fn json<Body: Serialize>(command: &'static str, loaded: &Loaded, body: Body) -> String {
    let envelope = Envelope {
        schema: SCHEMA,
        version: env!("CARGO_PKG_VERSION"),
        command,
        title: &loaded.project.title,
        project_sha256: &loaded.sha256,
        settings: &loaded.settings,
        catalogue_files: &loaded.catalogue_files,
        motion: loaded.project.motion().is_rotary().then_some("rotary"),
        identified: loaded.recorded.as_ref().map(body_in_use),
        body,
    };
    // Every output type has string keys and finite numbers by construction, so that nothing can fail here.
    serde_json::to_string_pretty(&envelope).unwrap_or_else(|error| format!("{{\"error\": \"{error}\"}}"))
}

/// A number with this many significant digits as TOML writes it.
pub(crate) fn in_toml(value: f64, digits: usize) -> String {
    let rounded = format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value);
    print_bare(rounded)
}
