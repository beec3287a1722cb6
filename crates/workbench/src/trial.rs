//! The output of trials: text, JSON, files and figures.

mod answer;
mod document;
mod words;

pub(crate) use answer::{TrialAnswer, body};
pub(crate) use document::{agreement_detail, document, words};
pub(crate) use words::{
    brief_reason, finding_words, have_one_name, machine_words, name_of, reason_words, run_name,
};
