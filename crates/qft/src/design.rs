//! The design of a controller and its prefilter: search, audit, and a new constraint for every
//! counterexample, until both agree.
//!
//! ```text
//! diagnose      a limit that no controller meets: the structures below are tried for the smallest relaxation alone
//! named         the controllers of a manual, the shortest first, until one meets every limit; longer ones that earn it
//! grow          structures of growing order, each begun from the controller before, until one meets every limit
//! fewer zeros   of the order that was found, as long as every limit is still met: the last such design is kept
//! relax         where none was found: the structure that came nearest, for the smallest relaxation
//! again         where that relaxation turns out to be none: this structure for the objective, then fewer zeros
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
mod stabilising;
mod tried;

pub use attempt::LoopDesignError;
pub use binding::BINDING_DB;
pub use candidates::gain_range;
pub use diagnosis::{Constraint, ConstraintPlace, Finding, FindingSeverity, SharedLimit, diagnose};
pub use last_search::{last_search, sample_beside_worst};
pub use named::name_of;
pub use outcome::{DesignOutcome, design_after, design_stricter};
pub use problem::{ControllerChoice, DesignOptions, PoleRange, PrefilterChoice};

pub use crate::loop_shaping::DesignProblem;
pub use phea_dynamics::controller::{NamedStructure, Objective};
pub use reshaped::reshaped;
pub use result::{Design, DesignRound, DesignStatus, Relaxation, Starts};
pub use run::{design, design_again};
pub use tried::{StructureEnding, TriedStructure};
