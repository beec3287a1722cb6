//! The output for the engineer: commands on a project, with the text, JSON, files and figures of
//! their answers, and the report.
//!
//! A shell hands in text and bytes through [`source::Source`] and prints what an [`answer::Answer`] holds.

pub mod alternatives;
pub mod answer;
pub mod audit;
pub mod bench;
pub mod campaign;
pub mod command;
pub mod derived;
pub mod design;
pub mod document;
pub(crate) mod error;
pub mod friction;
mod grouped;
pub mod identify;
pub mod line_test;
pub mod linearize;
pub(crate) mod motion;
pub(crate) mod over_time;
pub mod report;
pub mod response;
pub mod shaping;
pub mod simulate;
pub mod sizing;
pub mod specification;
pub mod trial;

pub use phea_engineering::{caveat, family, linear_loop, replaced, rig, robust, setup};
pub use phea_figure as figure;
pub use phea_project::{self as project, catalogue, source};
pub use phea_quantity::{self as quantity, spelling};
