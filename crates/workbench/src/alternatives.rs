//! The output of `alternatives`: text, JSON, files and a figure.

mod answer;
mod document;
mod files;
mod findings;

pub use phea_engineering::alternatives::*;

pub(crate) use answer::json;
pub(crate) use document::text;
pub(crate) use files::files;
