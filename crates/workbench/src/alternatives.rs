//! The output of `alternatives`: text, JSON, files and figures.

mod answer;
mod document;
mod files;
mod findings;
mod front;
mod summary;
mod words;

pub use phea_engineering::alternatives::*;

pub(crate) use answer::{AlternativesAnswer, body};
pub(crate) use document::{document, first_warnings, output, outside_words};
pub(crate) use files::{figures, files};
