//! The search against problems whose optimum is known.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

mod closed_forms;
mod forbidden;
mod formula;
mod published;
mod servo;
mod starts;
