//! Quantitative Feedback Theory: the limits that a closed loop must satisfy for every plant of an
//! uncertain family.
//!
//! ```text
//! UncertainPlant, members -> Family                                            the plants to be controlled
//! Controller, sensor -> Compensation; with a plant -> Member -> LoopResponse   the loop around each of them
//! ClosedLoop, Limit -> Requirement; with a band -> Specification               what is demanded of it
//! Family at a frequency -> Template; with a Requirement -> Bound               where the nominal loop may not be
//! Family, Compensation -> FamilyStability                                      whether every plant is stable
//! AuditProblem -> audit -> Audit                                               stability and the worst margins: searched
//! AuditProblem, Audit -> prove -> Certificate -> check                         the same for every plant: proven
//! Compensator -> Edit -> Compensator -> DesignChart                            shaped by hand
//! DesignProblem -> diagnose -> Finding                                         what no controller can achieve
//! DesignProblem -> Structure -> Shaping -> search -> PrefilterBand -> fit -> Audit -> Design
//!                                 ^---------- counterexamples ----------------'       shaped automatically
//! ```
//!
//! Frequencies in rad/s, angles in radians and gains as ratios, unless a name ends in `_deg` or
//! `_db`. Results are values: sentences about them are made in the crates above.
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
mod kept_plants;
pub mod loop_shaping;
pub mod manual_shaping;
pub mod prefilter;
pub mod proof;
pub mod specification;
mod specification_margin;
pub mod stability;
pub mod template;
mod verdict;
pub mod verification;
