//! The output of `bench`: text, JSON and tables.

mod answer;
mod document;

pub use phea_engineering::bench::*;

pub use answer::{files, json};
pub use document::text;
