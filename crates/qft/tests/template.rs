//! Templates against closed forms, against families whose image is known, and against random
//! plants.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

mod closed_forms;
mod filled;
mod loops;
mod resonance;
mod six_parameters;
mod support;
