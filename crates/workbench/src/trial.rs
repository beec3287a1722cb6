//! What is told of `trial`: text, JSON, files and figures.

mod answer;

pub use phea_engineering::trial::*;

pub(crate) use answer::{Body, HEADINGS, body, cells, reasons, text};
