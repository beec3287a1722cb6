//! The output of `design`: text, JSON, files and figures.

mod answer;
mod comparison;
mod document;
mod factors;
mod limits;
mod manual;
mod pressure_feedback;
mod relaxed;
mod repair;
mod rounding;
mod stages;
mod structures;
mod unfinished;
mod words;

pub use crate::explanation::explanation_sentence;
use phea_engineering::design::ProjectDesign;

pub use answer::pressure_feedback_object;
pub(crate) use answer::{DesignAnswer, body};
pub use document::output;
pub(crate) use document::{costs, explanation_words, laws, side_by_side, status};
pub use factors::factored;
pub(crate) use limits::document as limits;
pub(crate) use manual::document as manual;
pub(crate) use pressure_feedback::document as pressure_feedback;
pub use pressure_feedback::pressure_feedback_document;
pub(crate) use stages::{bound_files, drawn};
pub use stages::{files, stage_files};
pub(crate) use structures::document as structures;
pub(crate) use words::{rig_miss_words, verdict_sentence};

use crate::answer::Body;
use crate::quantity::MotionKind;
use phea_dynamics::linear::LinearError;

/// Prints a design as JSON, without the keys of every answer, for a rig of this motion.
///
/// # Errors
/// [`LinearError`] if a law has no transfer function.
pub fn printed(view: &ProjectDesign, motion: MotionKind) -> Result<String, LinearError> {
    Ok(body(view)?.into_object().print(motion))
}
