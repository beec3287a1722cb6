//! Quantitative Feedback Theory: the limits that a closed loop must satisfy for every plant of an
//! uncertain family.
//!
//! ```text
//! UncertainPlant, members -> Family                                            the plants to be controlled
//! Controller, sensor -> Compensation; with a plant -> Member -> LoopResponse   the loop around each of them
//! ClosedLoop, Limit -> Requirement; with a band -> Specification               the requirements on it
//! Family at a frequency -> Template; with a Requirement -> Bound               the forbidden region of the nominal loop
//! Family, Compensation -> FamilyStability                                      the stability of every plant
//! AuditProblem -> audit -> Audit                                               search for instability and the worst margins
//! AuditProblem, Audit -> prove -> Certificate -> check                         proof of both for every plant
//! Compensator -> Edit -> Compensator -> DesignChart                            shaping by hand
//! DesignProblem -> diagnose -> Finding                                         limits that no controller can meet
//! DesignProblem -> Structure -> Shaping -> search -> PrefilterBand -> fit -> Audit -> Design
//!                                 ^---------- counterexamples ----------------'       automatic shaping
//! ```
//!
//! Frequencies in rad/s, angles in radians and gains as ratios, unless a name ends in `_deg` or
//! `_db`. Results are values: the crates above word them.
//!
//! This crate knows plants only as `phea_dynamics::uncertain_plant::UncertainPlant` or as measured
//! responses; it never sees a valve or a hose.

pub mod audit;
pub mod bound;
pub mod closed_loop;
mod coordinate_climb;
pub mod design;
pub mod family;
pub mod inner_loop;
pub mod loop_shaping;
pub mod manual_shaping;
mod plant_cache;
pub mod prefilter;
pub mod proof;
pub mod specification;
mod specification_margin;
pub mod stability;
pub mod template;
mod verdict;
pub mod verification;
