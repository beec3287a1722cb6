//! Why a command failed, and the exit status that says so.

/// Why there is no answer, or not all of it was written.
#[derive(Debug)]
pub(crate) struct Failure {
    pub(crate) status: u8,
    /// For people.
    pub(crate) text: String,
    /// One JSON object, where a program asked; empty where there is none.
    pub(crate) json: String,
}

/// The answer is yes.
pub(crate) const DONE: u8 = 0;
/// The answer is no.
pub(crate) const NO: u8 = 1;
/// Something is wrong with what was asked.
pub(crate) const WRONG_INPUT: u8 = 2;
/// Something could not be written.
const NOT_WRITTEN: u8 = 3;

impl Failure {
    /// Something is wrong with what was asked.
    pub(crate) fn wrong_input(text: impl Into<String>) -> Failure {
        Failure { status: WRONG_INPUT, text: text.into(), json: String::new() }
    }

    /// Nothing is wrong with that, but something could not be written.
    pub(crate) fn not_written(message: &str) -> Failure {
        Failure { status: NOT_WRITTEN, text: format!("error: {message}"), json: String::new() }
    }

    pub(crate) fn with_json(self, json: String) -> Failure {
        Failure { json, ..self }
    }
}
