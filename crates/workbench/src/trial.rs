//! The output of trials: text, JSON, files and figures.

mod answer;
mod document;

pub use phea_engineering::trial::*;

pub(crate) use answer::body;
pub(crate) use document::{document, words};
