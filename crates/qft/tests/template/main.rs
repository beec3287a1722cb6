//! Templates against closed forms, against families whose image is known, and against random plants.

mod closed_forms;
mod filled;
mod loops;
mod resonance;
mod six_parameters;
mod support;
