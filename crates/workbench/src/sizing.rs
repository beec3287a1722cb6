//! The output of `size`: text, JSON, files and figures.

mod answer;
mod document;
mod words;

pub use answer::files;
pub(crate) use answer::{SizeAnswer, body};
pub(crate) use document::document;
pub(crate) use words::{coil_unknown_words, hose_name, length_words, model_name, uncertain_name};
