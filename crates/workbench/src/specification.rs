//! The output on specifications: text and JSON.

mod answer;

pub use phea_engineering::specification::*;

pub(crate) use answer::{document, wish_row};
