//! The prefilter: the band that a loop leaves for it, and what fits into that.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

mod band;
mod fitted;
mod loops;
