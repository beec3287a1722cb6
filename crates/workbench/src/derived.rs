//! What is told of `derived`: text, JSON, files and figures.

mod answer;

pub use phea_engineering::derived::*;

pub use answer::{files, json, text, visited_text};
pub(crate) use answer::{sentence, stated};
