//! The output of `shape`: text, JSON, files and figures.

mod answer;
mod document;
mod refused;
mod words;

pub use answer::{SHAPED_PROJECT, files};
pub(crate) use answer::{ShapeAnswer, body};
pub(crate) use document::document;
pub(crate) use refused::with_text;
pub use words::pass_words;
