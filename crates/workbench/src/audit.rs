//! What is told of `audit`: text, JSON, files and figures.

mod answer;
mod text;

pub use phea_engineering::audit::*;

pub(crate) use answer::{Body, body};
pub use answer::{files, json, json_on_machine};
pub use text::text;
pub(crate) use text::{basis, summary, worst_plants};
