//! The output of `identify`: text, JSON and the fragment of a project file.

mod answer;
mod document;
mod figures;
mod files;
mod fragment;
mod from_recordings;
mod in_use;
mod misfit;
mod numbers;
mod region;

pub(crate) use answer::IdentifiedValveAnswer;
pub use answer::json;
pub(crate) use document::document;
pub(crate) use document::{write_coefficients, write_signals};
pub(crate) use figures::ValveFigures;
pub use files::Read;
pub use fragment::files;
pub use from_recordings::{ValveInUseError, in_use, recorded_files};
pub(crate) use in_use::{in_use_above, write_in_use};
pub(crate) use numbers::{is_valve_of_thesis, write as write_numbers};
pub use region::FoundRegion;
pub(crate) use region::file;
