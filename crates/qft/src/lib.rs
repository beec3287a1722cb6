//! Quantitative Feedback Theory: what a closed loop must keep to, for every plant of an uncertain family.
//!
//! This crate knows plants only as `phea_dynamics::uncertain_plant::UncertainPlant`; it never sees a valve or a hose.

pub mod specification;
