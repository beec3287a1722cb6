//! The design of a controller and its prefilter: search, audit, and a new constraint for every
//! counterexample, until both agree.
//!
//! ```text
//! diagnose      a limit that no controller meets: the structures below are searched for the smallest relaxation only
//! named         the controllers of a manual, the shortest first, until one meets every limit; then longer ones that earn their poles
//! grow          structures of growing order, each starting from the controller before, until one meets every limit
//! fewer zeros   at the order found, as long as every limit is still met: the last such design is retained
//! relax         if no design was found: the nearest structure, for the smallest relaxation
//! again         if that relaxation is zero: this structure for the objective, then fewer zeros
//! ```

mod attempt;
mod binding;
mod candidates;
mod counterexample;
mod diagnosis;
mod feedback_sign;
mod last_search;
mod named;
mod nearest;
mod outcome;
mod problem;
pub mod quantization;
mod queue;
mod reshaped;
mod result;
mod run;
mod searched;
mod stabilising;

pub use attempt::LoopDesignError;
pub use binding::BINDING_DB;
pub use candidates::gain_range;
pub use diagnosis::{Constraint, ConstraintPlace, Finding, FindingSeverity, SharedLimit, diagnose};
pub use last_search::{last_search, sample_near_worst};
pub use named::name_of;
pub use outcome::{DesignOutcome, design_after, design_stricter};
pub use problem::{ControllerChoice, DesignOptions, PoleRange, PrefilterChoice};

pub use crate::loop_shaping::DesignProblem;
pub use phea_dynamics::controller::{NamedStructure, Objective};
pub use reshaped::reshaped;
pub use result::{Design, DesignRound, DesignStatus, Relaxation, Starts};
pub use run::{design, design_again};
pub use searched::{SearchedStructure, StructureEnding};
