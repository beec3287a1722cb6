//! The output of `simulate --check`.

mod answer;

use phea_engineering::simulate::*;

pub(crate) use answer::{ToleranceCheckAnswer, answer, sentences};
