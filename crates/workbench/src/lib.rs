//! The engineer's procedures.

pub mod catalogue;
pub mod project;
pub mod quantity;
pub mod source;
pub mod spelling;
