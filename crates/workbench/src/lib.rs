//! The engineer's procedures.
