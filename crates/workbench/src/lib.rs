//! The output for the engineer: commands on a project, with the text, JSON, files and figures of
//! their answers, and the report.
//!
//! A shell passes text and bytes through [`source::Source`] and prints what an
//! [`Answer`](struct@answer::Answer) holds. [`command::answer_into`] turns one into the other:
//!
//! ```text
//! command::Request, project::Loaded     the request, and the project
//!   identify::in_use -> Loaded          the project with the values from its recordings
//!   line_choice -> Loaded               lines without a stated model get one
//!   setup::Setup                        the rig, the controller, the sensor: the input of every procedure
//!   engineering procedure -> values     ProjectAudit, Linearization, ScenarioRun, ...
//!     X/document.rs -> document::Document   for people: blocks, tables of typed cells
//!     X/answer.rs   -> answer::Object       for programs, in the envelope of answer::envelope
//!     X/figures.rs  -> figure::Figure       drawn as SVG, as files and on the page
//!     report.rs     -> chapters             Documents and Figures, one after another on a page
//!   command::unprinted::Unprinted { document: Document, body: Object, files, affirmative }
//!     printed below the values from recordings; a rig that turns has its own names for programs (motion.rs)
//! answer::Answer { text, json, files, affirmative }
//! ```
//!
//! The module X of a procedure has the name of that procedure's module in `phea_engineering`, which
//! applications reach as [`engineering`]. The list of `derived` quantities is output only: no
//! procedure reads it.

pub mod alternatives;
pub mod answer;
pub mod audit;
pub mod bench;
pub mod bound_values;
pub mod campaign;
pub mod caveat;
pub mod command;
pub mod derived;
pub mod design;
pub mod document;
pub(crate) mod error;
mod explanation;
pub mod export;
pub mod friction;
mod grouped;
pub mod identify;
mod impossible;
mod impossible_steps;
mod limit_kind;
mod line_choice;
pub mod line_test;
pub mod linear_values;
pub mod linearize;
pub(crate) mod over_time;
pub mod plant_names;
pub mod plant_values;
pub mod report;
pub mod response;
pub mod rig_values;
pub mod shaping;
pub mod simulate;
pub mod sizing;
pub mod specification;
pub mod trial;
mod unit_encoding;
mod verdict_words;

pub use phea_engineering as engineering;
pub use phea_figure as figure;
pub use phea_project::{self as project, catalogue, source};
pub use phea_quantity::{self as quantity, spelling};
