//! The engineer's procedures: read a project, derive what follows from it, size, linearise, report.
//!
//! A shell hands in text and bytes through [`source::Source`] and prints what an [`answer::Answer`] holds.

pub mod answer;
pub mod audit;
pub mod campaign;
pub mod catalogue;
pub mod caveat;
pub mod command;
pub mod control;
pub mod derived;
pub mod design;
pub mod family;
pub mod figure;
pub mod linear_loop;
pub mod linearize;
pub mod project;
pub mod quantity;
pub mod report;
pub mod rig;
pub mod robust;
pub mod setup;
pub mod shaping;
pub mod simulate;
pub mod sizing;
pub mod source;
pub mod specification;
pub mod spelling;
pub mod trial;
