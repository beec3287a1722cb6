//! The error of a text that is not a quantity.

use std::ops::Range;

/// The error of a quantity, and where it is in its text.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct QuantityError {
    /// What is wrong, in one sentence.
    pub message: String,
    /// Where, in bytes of the text.
    pub range: Range<usize>,
    /// What was expected there.
    pub expected: Option<String>,
    /// The nearest valid spelling, or what to do.
    pub help: Option<String>,
}

impl QuantityError {
    pub(crate) fn new(message: impl Into<String>, range: Range<usize>) -> Self {
        QuantityError { message: message.into(), range, expected: None, help: None }
    }

    pub(crate) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}
