//! The output of `identify`: text, JSON and the fragment of a project file.

mod answer;
mod document;
mod figures;
mod files;
mod in_use;
mod numbers;
mod region;

pub use phea_engineering::identify::*;

pub use answer::{files, json};
pub(crate) use document::document;
pub(crate) use document::{tell_coefficients, tell_signals};
pub(crate) use figures::ValveFigures;
pub use files::Read;
pub(crate) use in_use::{in_use_above, tell_in_use};
pub(crate) use numbers::{is_valve_of_thesis, tell as tell_numbers};
pub use region::FoundRegion;
pub(crate) use region::file;
