//! The output of `check`: text, JSON, files and figures.

mod answer;
mod document;

pub use phea_engineering::derived::*;

pub(crate) use answer::body;
pub use answer::files;
pub(crate) use document::{document, replaced_sentences, replaced_table, visited};
