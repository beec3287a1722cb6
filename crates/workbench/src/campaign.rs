//! What is told of `campaign`: text, JSON, files and figures.

mod answer;
mod figures;
mod text;

pub use phea_engineering::campaign::*;

pub(crate) use answer::{json, run_json};
pub(crate) use figures::{files, pictures};
pub(crate) use text::{counted, lump_words, metric_words, run_text, text, without};
