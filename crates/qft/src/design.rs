//! The design of a controller and its prefilter: search, audit, and a new constraint for every
//! counterexample, until both agree.

mod attempt;
mod binding;
mod candidates;
mod counterexample;
mod diagnosis;
mod feedback_sign;
mod problem;
pub mod quantization;
mod result;
mod run;
mod stabilising;

pub use attempt::LoopDesignError;
pub use candidates::gain_range;
pub use diagnosis::{Constraint, ConstraintPlace, Finding, FindingSeverity, Party, SharedLimit, diagnose};
pub use problem::{ControllerChoice, DesignOptions, DesignProblem, PrefilterChoice};

pub use phea_dynamics::controller::Objective;
pub use result::{BindingLimit, Conflict, Design, DesignRound, DesignStatus, Relaxation, Starts};
pub use run::{DesignOutcome, design, design_again};
