//! The prefilter: the band that a loop leaves for it, and prefilters that fit into it.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

mod band;
mod fitted;
mod loops;
