//! The output on specifications: text and JSON.

mod answer;
mod late;
mod names;
mod requirement;

pub(crate) use answer::{CheckedRequirementAnswer, RequiredStepAnswer, document, requirement_answer};
pub(crate) use late::late;
pub(crate) use names::{name_words, number_cell, numbered, numbered_cell, stated, subject_words};
pub use requirement::requirement_sentence;
