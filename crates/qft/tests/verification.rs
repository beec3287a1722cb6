//! Verification: verdicts that hold between the frequencies and between the grid points.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

mod as_bad;
mod dead_time;
mod ends;
mod examples;
mod given_frequency;
pub(crate) mod plants;
mod properties;
mod reach;
pub(crate) mod thesis;
