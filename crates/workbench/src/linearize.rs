//! What is told of `linearize`: text, JSON, files and figures.

mod answer;
mod sweep_answer;

pub use phea_engineering::linearize::*;

pub(crate) use answer::{
    comparisons, difference_text, located, mode_words, models, passivity_sentence, root_list,
};
pub use answer::{files, json, json_swept, text};
pub use sweep_answer::sweep_text;
pub(crate) use sweep_answer::{sweep_figure, sweep_files};
