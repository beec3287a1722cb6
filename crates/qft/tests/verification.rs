//! Verification: verdicts that hold between the frequencies and between the grid points.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

#[path = "verification/dead_time.rs"]
mod dead_time;
#[path = "verification/ends.rs"]
mod ends;
#[path = "verification/examples.rs"]
mod examples;
#[path = "verification/given_frequency.rs"]
mod given_frequency;
#[path = "verification/plants.rs"]
mod plants;
#[path = "verification/properties.rs"]
mod properties;
#[path = "verification/reach.rs"]
mod reach;
#[path = "rig/thesis.rs"]
mod rig;
#[path = "verification/thesis.rs"]
mod thesis;
