//! Templates against closed forms, against families with a known image, and against random plants.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

mod closed_forms;
mod filled;
mod loops;
mod resonance;
mod six_parameters;
mod support;
