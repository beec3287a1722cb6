//! What is told of `identify`: text, JSON and the fragment of a project file.

mod answer;
mod document;
mod files;

pub use phea_engineering::identify::*;

pub use answer::{files, json};
pub use document::text;
pub use files::Read;
