//! The language of a rig from outside: what is read, what is refused, and how.
#![cfg(test)]

mod alternative;
mod catalogue_parts;
mod consequences;
mod formula;
mod malformed;
mod mutation;
mod percentages;
mod plausible;
mod reading;
mod schema;
