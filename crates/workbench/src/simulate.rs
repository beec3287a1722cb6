//! The output of `simulate`: text, JSON, files and figures.

mod answer;
mod check;
mod compared;
mod document;
mod exceeded;
mod figures;
mod force_limits;
mod foreseen;
mod frequency;
mod laid_over;
mod metrics;
mod occurrence_kind;
mod reasons;
mod repetition;
mod required;
mod requirement;
mod run_status;
mod span;
mod together;

pub(crate) use answer::{
    CompareAnswer, ScenariosAnswer, SimulateAnswer, SteppedAnswer, body, comparison_body, frequency_body,
    scenarios, stepped,
};
pub(crate) use document::{
    adjustment_sentence, cause_cell, cause_words, coarse_sentence, comparison, document, gas_sentence,
    headline, measured, metrics_row, occurrence_sentences, published, published_row, requirement_of, windows,
};
pub(crate) use exceeded::exceeded_words;
pub(crate) use figures::{comparison_files, figure_files, pictures, turns};
pub(crate) use force_limits::{beyond_reach, force};
pub(crate) use foreseen::foreseen_late;
pub(crate) use frequency::{
    document as frequency_document, files as frequency_files, pictures as frequency_pictures,
};
pub(crate) use laid_over::{OverlaidRun, laid_over};
pub(crate) use metrics::{cells_of, label_within, settling_cell, shown_in};
pub(crate) use occurrence_kind::CampaignOccurrenceKind;
pub(crate) use reasons::{status_words, unmeasured_words};
pub(crate) use required::{
    Satisfaction, WorstStepAnswer, not_judged_words, requirement_sentence, satisfied_word,
};
pub(crate) use requirement::{
    reached_cell, reached_words, required_cell, required_overshoot, required_rise, required_settling,
    required_words,
};
pub(crate) use span::around;
pub(crate) use together::{NamedRun, at_a_glance, close_ups, measured_together, together};
