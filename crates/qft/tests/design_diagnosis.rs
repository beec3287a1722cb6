//! Findings on a design problem before any search.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

mod contradictions;
mod limits_of_performance;
mod mistakes;
mod problems;
mod published;
mod soundness;
mod whole_families;
