//! Quantitative Feedback Theory: the limits that a closed loop must satisfy for every plant of an
//! uncertain family.
//!
//! This crate knows plants only as `phea_dynamics::uncertain_plant::UncertainPlant` or as measured
//! responses; it never sees a valve or a hose.

pub mod audit;
pub mod bound;
pub mod closed_loop;
pub mod design;
pub mod family;
pub mod loop_shaping;
pub mod manual_shaping;
pub mod prefilter;
pub mod proof;
mod sampled;
pub mod specification;
pub mod stability;
pub mod template;
pub mod verification;
