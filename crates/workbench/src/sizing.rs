//! What is told of `sizing`: text, JSON, files and figures.

mod answer;

pub use phea_engineering::sizing::*;

pub(crate) use answer::{alike, answer_sentence};
pub use answer::{files, json, text};
