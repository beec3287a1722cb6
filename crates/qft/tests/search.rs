//! The search against problems with a known optimum.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

mod closed_forms;
mod forbidden;
mod formula;
mod published;
mod servo;
mod starts;
