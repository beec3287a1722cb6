//! The engineer's procedures: read a project, derive what follows from it, size, linearise, report.
//!
//! A shell hands in text and bytes through [`source::Source`] and prints what an [`answer::Answer`] holds.

pub mod answer;
pub mod audit;
pub mod campaign;
pub mod caveat;
pub mod command;
pub mod control;
pub mod derived;
pub mod design;
pub mod family;
pub mod linear_loop;
pub mod linearize;
pub mod report;
pub mod rig;
pub mod robust;
pub mod setup;
pub mod shaping;
pub mod simulate;
pub mod sizing;
pub mod specification;
pub mod trial;

pub use phea_figure as figure;
pub use phea_project::{self as project, catalogue, source};
pub use phea_quantity::{self as quantity, spelling};
