//! What is said of a design problem before any search.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

#[path = "design_diagnosis/contradictions.rs"]
mod contradictions;
#[path = "design_diagnosis/limits_of_performance.rs"]
mod limits_of_performance;
#[path = "design_diagnosis/mistakes.rs"]
mod mistakes;
#[path = "design_diagnosis/problems.rs"]
mod problems;
#[path = "design_diagnosis/published.rs"]
mod published;
#[path = "rig/thesis.rs"]
mod rig;
#[path = "design_diagnosis/soundness.rs"]
mod soundness;
#[path = "design_diagnosis/whole_families.rs"]
mod whole_families;
