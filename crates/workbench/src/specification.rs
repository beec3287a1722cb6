//! The output on specifications: text and JSON.

mod answer;
mod late;
mod stated;
mod wish;

pub use phea_engineering::specification::*;

pub(crate) use answer::{document, wish_row};
pub(crate) use late::late;
pub(crate) use stated::{stated, stated_words};
pub use wish::wish_sentence;
