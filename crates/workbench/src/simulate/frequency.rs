//! The output of `simulate --frequency-response`: text, JSON, files and figures.

mod answer;
mod document;
mod figures;

use phea_engineering::simulate::*;

pub(crate) use answer::{MachineResponsesAnswer, body, files};
pub(crate) use document::document;
pub(crate) use figures::pictures;
