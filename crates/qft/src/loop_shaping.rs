//! Loop shaping: a controller with free numbers, what every plant makes of it, and the search for the best one.
//!
//! ```text
//! structure x -> G(j w; x) -> margins of the samples (plant, frequency, specification) -> descent -> x
//! ```
//!
//! All free numbers are natural logarithms, so that every search direction is a change by factors.

mod sample_stability;
mod search;
mod structure;

pub use sample_stability::{SampleJudgement, SampleStability};
pub use search::{Aim, Judgement, MarginRow, SearchProblem, Slopes};
pub use structure::{Part, Structure};
