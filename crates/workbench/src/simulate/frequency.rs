//! The output of `simulate --frequency-response`: text, JSON, files and figures.

mod answer;
mod figures;
mod text;

use phea_engineering::simulate::*;

pub(crate) use answer::{body, files};
pub(crate) use figures::pictures;
pub(crate) use text::text;
