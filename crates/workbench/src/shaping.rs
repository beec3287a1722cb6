//! The output of `shape`: text, JSON, files and figures.

mod answer;
mod text;

pub use phea_engineering::shaping::*;

pub use answer::{SHAPED_PROJECT, files, json};
pub use text::text;
