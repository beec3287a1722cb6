//! The output on specifications: text and JSON.

mod answer;
mod late;
mod wish;

pub use phea_engineering::specification::*;

pub(crate) use answer::{document, wish_row};
pub(crate) use late::late;
pub use wish::wish_sentence;
