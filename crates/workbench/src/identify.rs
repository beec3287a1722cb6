//! The output of `identify`: text, JSON and the fragment of a project file.

mod answer;
mod document;

pub use phea_engineering::identify::*;

pub use answer::{files, json};
pub use document::text;
