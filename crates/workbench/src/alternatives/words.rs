//! The reasons for which something of an alternative is not known, in words.

use phea_engineering::alternatives::{NoDesign, NotKnown};

use crate::design::verdict_sentence;
use crate::explanation::design_error_words;

/// The reason for the absence of a design.
pub(super) fn no_design_words(reason: &NoDesign) -> String {
    match reason {
        NoDesign::NoHose(reason) => reason.clone(),
        NoDesign::Failed(error) => design_error_words(error),
    }
}

/// The reason for which a number or a verdict is not known.
pub(super) fn not_known_words(reason: &NotKnown) -> String {
    match reason {
        NotKnown::NoDesign(reason) => no_design_words(reason),
        NotKnown::Design(verdict) => verdict_sentence(verdict),
        NotKnown::Other(reason) => reason.clone(),
    }
}
