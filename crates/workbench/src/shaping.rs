//! The output of `shape`: text, JSON, files and figures.

mod answer;
mod document;

pub use phea_engineering::shaping::*;

pub use answer::{SHAPED_PROJECT, files, json};
pub(crate) use document::document;
