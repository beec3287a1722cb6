//! The output of `alternatives`: text, JSON, files and figures.

mod answer;
mod document;
mod files;
mod findings;
mod front;
mod printed;
mod summary;
mod words;

pub(crate) use answer::{AlternativesAnswer, body};
pub(crate) use document::{document, first_warnings, output};
pub(crate) use files::{figures, files};
pub(crate) use printed::{
    EncodedTask, PrintedAlternatives, PrintedTask, decoded, encoded, joined, outside_words,
};
