//! Language of a rig through the public interface: accepted and rejected projects, and the
//! messages.
#![cfg(test)]

mod alternative;
mod catalogue_parts;
mod consequences;
mod formula;
mod malformed;
mod mutation;
mod open_rig;
mod percentages;
mod plausible;
mod reading;
mod schema;
