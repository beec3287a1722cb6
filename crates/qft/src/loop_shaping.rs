//! Loop shaping: a controller with free parameters, the closed loops that it forms with every
//! plant, and the search for the best one.
//!
//! ```text
//! structure x -> G(j w; x) -> margins of the samples (plant, frequency, specification) -> descent -> x
//! ```
//!
//! All free numbers are natural logarithms, so that every search direction is a change by factors.

mod best_seen;
mod descent;
mod margins;
mod problem;
mod sample_stability;
mod samples;
mod search;
mod shaping;
mod start;
mod structure;
mod subproblem;
mod triplets;
mod wider;

pub(crate) use best_seen::BestSeen;
pub use descent::{Binding, DescentOptions, DescentResult, DescentStatus, DescentWork, descend};
pub use problem::DesignProblem;
pub use sample_stability::{SampleJudgement, SampleStability};
pub use samples::{Samples, SamplesError, search_frequencies};
pub use search::{Aim, Judgement, MarginRow, SearchProblem, Slopes};
pub use shaping::Shaping;
pub(crate) use start::search_seeing;
pub use start::{DescentEnd, SearchOptions, SearchResult, SearchStatus, search};
pub use structure::{Structure, StructureFactor, StructureResponse};
pub use wider::LocalOptimum;
