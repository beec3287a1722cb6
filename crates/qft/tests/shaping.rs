//! What a search of a loop sees: structures, samples, margins and their slopes, against plain evaluations.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

#[path = "shaping/delay.rs"]
mod delay;
#[path = "shaping/margins.rs"]
mod margins;
#[path = "shaping/published.rs"]
mod published;
#[path = "shaping/random.rs"]
mod random;
#[path = "rig/thesis.rs"]
mod rig;
#[path = "shaping/samples.rs"]
mod samples;
#[path = "shaping/slopes.rs"]
mod slopes;
#[path = "shaping/structure.rs"]
mod structure;
