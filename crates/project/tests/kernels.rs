//! Kernels that cannot be reached from outside, compiled here once more for the unit tests next to
//! their code.
#![allow(dead_code, unreachable_pub, reason = "a kernel's callers stay in the library")]

#[path = "../src/rewrite/statement.rs"]
mod statement;
#[path = "../src/rewrite/surgery.rs"]
mod surgery;
