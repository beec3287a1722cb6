//! Designs whose truth is known: published examples, closed forms, and what an independent search finds.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

#[path = "design/contract.rs"]
mod contract;
#[path = "design/problems.rs"]
mod problems;
#[path = "design/published.rs"]
mod published;
#[path = "design/relaxed.rs"]
mod relaxed;
#[path = "design/rounded.rs"]
mod rounded;
#[path = "design/servo.rs"]
mod servo;
