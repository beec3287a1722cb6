//! The output of `linearize`: text, JSON, files and figures.

mod answer;
mod document;
mod sweep_answer;
mod words;

pub use answer::files;
pub(crate) use answer::{LinearizeAnswer, PassivityAnswer};
pub(crate) use answer::{body, body_swept, passivity as passivity_body};
pub(crate) use document::output;
pub(crate) use document::{
    document, impedance_at_joint, linkage_table, model_words, models, passivity_sentence,
    required_impedance_sentence, required_impedance_table, roots,
};
pub(crate) use sweep_answer::sweep_document;
pub(crate) use sweep_answer::{sweep_figure, sweep_files};
pub(crate) use words::{hiding_mass_words, no_closed_impedance_words, stiffness_sentence, stiffness_words};
