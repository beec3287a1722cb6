//! The output of `identify`: text, JSON and the fragment of a project file.

mod answer;
mod document;
mod files;
mod region;

pub use phea_engineering::identify::*;

pub use answer::{files, json};
pub use document::text;
pub use files::Read;
pub use region::FoundRegion;
pub(crate) use region::file;
