//! What a command answers: a text for people, one JSON object for programs, and files.
//!
//! The JSON of an answer is a struct that derives [`Answer`](phea_derive::Answer): its fields are the
//! keys, their documentation describes them in the schema. This module gives all answers the same
//! keys in front and the same treatment of numbers that do not exist.

mod chosen_lines;
mod describe;
mod envelope;
mod file_warning;
mod known;
mod object;
mod pictures;
mod recorded;
mod schema;
mod shape;
mod values;
mod words;

use crate::document::Document;
use crate::quantity::print_bare;
pub use crate::quantity::significant;
pub use object::Object;
pub(crate) use phea_engineering::csv::{Csv, quoted};
pub use phea_engineering::number_table::{NumberTable, TableFormat};

pub use crate::source::OutputFile;
pub(crate) use chosen_lines::hindrance_words;
pub(crate) use describe::{Body, Describe, Field, Perhaps};
pub(crate) use envelope::{SCHEMA, VERSION, envelope};
pub(crate) use file_warning::FileWarningAnswer;
pub(crate) use known::{Entries, KeyList, Keyed, OrReason, PutTogether, Reasoned};
pub(crate) use object::{Json, ObjectKey};
pub(crate) use phea_derive::Answer;
pub(crate) use pictures::picture_files;
pub use pictures::{picture_at, picture_of};
pub(crate) use recorded::{RecordedAnswer, body_in_use, unchanged_because};
pub(crate) use schema::{CommandAnswer, schema_of};
pub(crate) use shape::{EitherShape, Members, ObjectShape, ValueShape, WordList};
pub(crate) use words::{Word, describe_words, words};

/// The answer of a command, ready to be printed and written by a shell.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// Tables and short sentences for people.
    pub document: Document,
    /// One JSON object.
    pub json: String,
    /// Files for the output folder; the PNG of a drawing, which [`picture_of`] makes, is written
    /// with it.
    pub files: Vec<OutputFile>,
    /// Whether the answer is yes; a no ends the command with status 1.
    pub affirmative: bool,
}

impl Answer {
    /// The document as text for a terminal.
    pub fn text(&self) -> String {
        self.document.text()
    }

    /// The figures that a page of the text has, in order: SVG, each under its name.
    pub fn drawings(&self) -> Vec<OutputFile> {
        picture_files(&self.document.clone().into_figures())
    }
}

/// A number with this many significant digits as TOML writes it.
pub(crate) fn in_toml(value: f64, digits: usize) -> String {
    let rounded = format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value);
    print_bare(rounded)
}
