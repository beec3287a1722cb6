use phea_engineering::setup::Setup;

use crate::caveat::of_models_in_words;
use crate::document::{Document, StatusMark};

/// A chapter of the report.
pub(super) struct Chapter {
    /// Anchor of the chapter on the page.
    pub(super) anchor: &'static str,
    /// Heading.
    pub(super) title: &'static str,
    /// Content below the heading.
    pub(super) document: Document,
}

impl Chapter {
    /// A chapter with the content of a document.
    pub(super) const fn of(anchor: &'static str, title: &'static str, document: Document) -> Chapter {
        Chapter { anchor, title, document }
    }
}

impl Document {
    /// Adds the effects that a chapter on the linear loop does not include, if any.
    pub(super) fn left_out(&mut self, setup: &Setup<'_>) {
        for sentence in of_models_in_words(setup) {
            self.verdict(StatusMark::Note, sentence, vec![]);
        }
    }
}
