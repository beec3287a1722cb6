//! The engineer's procedures.

pub mod figure;
