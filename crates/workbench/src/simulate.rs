//! What is told of `simulate`: text, JSON, files and figures.

mod answer;
mod check;
mod figures;
mod frequency;
mod text;
mod together;

pub use phea_engineering::simulate::*;

pub(crate) use answer::{Body, body, compare_json, frequency_json, json};
pub(crate) use figures::{comparison_files, figure_files, picture_files, pictures};
pub(crate) use frequency::{
    files as frequency_files, pictures as frequency_pictures, text as frequency_text,
};
pub(crate) use text::{
    ABSENT, MEASURED, METRICS, cause_words, cells_of, coarse_sentence, compare_text, headline,
    measured_cells, occurrence_sentences, small_as_zero, text,
};
pub(crate) use together::{Named, at_a_glance, close_ups, measured_together, together};
