//! The output of `campaign`: text, JSON, files and figures.

mod answer;
mod document;
mod figures;

pub(crate) use answer::{CampaignAnswer, CampaignRunAnswer, body, run_body};
pub(crate) use document::{
    beyond_box, counted, document, left_out, lumps, metrics, requirement, run_document,
};
pub(crate) use figures::{files, pictures};
