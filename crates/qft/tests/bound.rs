//! Bounds: against published examples, against the elementary method, and against the closed loops.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod phases;
mod plain;
mod properties;
mod published;
mod random;
