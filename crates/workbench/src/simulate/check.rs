//! What is told of `simulate::check`: text, JSON, files and figures.

mod answer;

use phea_engineering::simulate::*;

pub(crate) use answer::{row, sentences};
