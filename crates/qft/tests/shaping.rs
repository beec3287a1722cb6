//! Interface of a search to a loop: structures, samples, margins and their slopes, against plain
//! evaluations.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

mod delay;
mod margins;
mod published;
mod random;
mod samples;
mod slopes;
mod structure;
