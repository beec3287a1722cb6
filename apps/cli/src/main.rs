//! The phea command.
fn main() {}
