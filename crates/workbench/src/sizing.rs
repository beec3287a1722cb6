//! The output of `size`: text, JSON, files and figures.

mod answer;
mod document;

pub use phea_engineering::sizing::*;

pub(crate) use answer::body;
pub use answer::files;
pub(crate) use document::document;
