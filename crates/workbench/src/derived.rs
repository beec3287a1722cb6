//! The output of `check`: every quantity that follows from the declarations of a project, with its
//! equation, and any contradiction with a declared one, as text, JSON and files.

mod accumulator;
mod answer;
mod chamber_valves;
mod document;
mod dynamics;
mod flow;
mod friction;
mod impedance;
mod linear;
mod lines;
mod linkage;
mod list;
mod moving;
mod operating_point;
mod parts;
mod quantity;
mod rig;
mod series;
mod sizing;
mod stiffness;
mod valve;

pub use quantity::{Derived, Stated};
pub use rig::derive;

pub use answer::files;
pub(crate) use answer::{DerivedAnswer, body};
pub(crate) use document::{document, replaced_sentences, replaced_table, visited};
