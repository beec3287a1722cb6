//! Files that run the controller of a project elsewhere, as it was verified.
//!
//! ```text
//! Deployed + Contract -> c::files -> NAME.h, NAME.c, NAME_self_test.c, example_main.c
//! ```

pub mod c;
mod contract;
mod vectors;

pub use contract::Contract;
pub use vectors::{TestVector, VectorOperation, test_vectors};
