//! What is told of `specification`: text, JSON, files and figures.

mod answer;

pub use phea_engineering::specification::*;

pub(crate) use answer::{text, wish_row};
