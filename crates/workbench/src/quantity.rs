//! Quantities in text: `"70 bar"`, `"4.7 cc/ft"`, `"9.8 L/min"`, and back.
//!
//! The only place of the workspace with factors between units. Inside, every number is SI.

mod dimension;

pub use dimension::*;
