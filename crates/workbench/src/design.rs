//! What is told of `design`: text, JSON, files and figures.

mod answer;
mod stages;
mod text;

pub use phea_engineering::design::*;

pub use answer::json;
pub use stages::{files, stage_files};
pub(crate) use text::explanation_words;
pub use text::text;
