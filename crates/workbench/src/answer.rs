//! What a command answers: a text for people, one JSON object for programs, and files.
//!
//! Each command has one typed output; this module gives all of them the same envelope and the same
//! treatment of numbers that do not exist.

mod chosen_lines;
mod number;
mod object;
mod pictures;
mod recorded;

use crate::quantity::print_bare;
pub use crate::quantity::significant;
pub use number::Number;
pub(crate) use object::Json;
pub use object::Object;
pub(crate) use phea_engineering::csv::{Csv, quoted};
pub use phea_engineering::number_table::{NumberTable, TableFormat};

pub use crate::source::OutputFile;
use chosen_lines::body_of_lines;
pub(crate) use chosen_lines::hindrance_words;
pub use pictures::picture_of;
pub(crate) use pictures::{part_files, picture_files};
pub(crate) use recorded::{body_in_use, kept_because};

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

/// The keys of every JSON object in front of those of the command.
pub(crate) fn envelope(command: &'static str, loaded: &Loaded) -> Object {
    Object::new()
        .with("schema", SCHEMA)
        .with("version", env!("CARGO_PKG_VERSION"))
        .with("command", command)
        .with("title", loaded.project.title.as_str())
        .with("project_sha256", loaded.sha256.as_str())
        .with("settings", loaded.settings.as_slice())
        .with("catalogue_files", loaded.catalogue_files.as_slice())
        // of a rig that turns: its torques are in N m and its angles in rad
        .maybe("motion", loaded.project.motion().is_rotary().then_some("rotary"))
        .maybe("identified", loaded.recorded.as_ref().map(body_in_use))
        .maybe("line_model", loaded.lines.as_ref().map(|lines| body_of_lines(lines, loaded.project.motion())))
}

/// A number with this many significant digits as TOML writes it.
pub(crate) fn in_toml(value: f64, digits: usize) -> String {
    let rounded = format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value);
    print_bare(rounded)
}
