//! Designs with known results: published examples, closed forms, and results of an independent
//! search.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

mod additional_plant;
mod contract;
mod fed_forward;
mod named;
mod problems;
mod published;
mod relaxed;
mod reserve;
mod rounded;
mod servo;
mod stricter;
mod unstable;
