//! The output of `bench`: text, JSON and tables.

mod answer;
mod document;
mod friction;
mod line;

pub use phea_engineering::bench::*;

pub use answer::{files, json};
pub use document::text;
pub use line::{line_files, line_text};
