//! Figures from outside: what is drawn, and that it can be read.
#![cfg(test)]

mod circuit;
mod colours;
mod drawn;
#[path = "../src/family_step/edge.rs"]
mod edge;
#[path = "../examples/figures/gallery.rs"]
mod gallery;
mod hostile;
mod legibility;
mod primitives;
mod qft;
