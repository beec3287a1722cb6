//! Kernels that cannot be reached from outside, compiled here once more for the unit tests next to
//! their code: the library itself is not built for tests.
#![allow(dead_code, reason = "a kernel's callers stay in the library")]

#[path = "../src/motion/vocabulary.rs"]
mod vocabulary;
