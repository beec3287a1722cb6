//! The output of `size`: text, JSON, files and figures.

mod answer;
mod document;

pub use phea_engineering::sizing::*;

pub use answer::{files, json};
pub(crate) use document::document;
