//! Figures through the public interface: their content, and legibility.
#![cfg(test)]

mod circuit;
mod colours;
mod drawn;
#[path = "../examples/figures/gallery.rs"]
mod gallery;
mod hostile;
mod legibility;
mod nichols;
mod primitives;
mod qft;
