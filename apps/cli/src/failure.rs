//! Why a command failed, and its exit status.

/// Why there is no answer, or not all of it was written.
#[derive(Debug)]
pub(crate) struct Failure {
    pub(crate) status: u8,
    /// For people.
    pub(crate) text: String,
    /// One JSON object, if it was requested; otherwise empty.
    pub(crate) json: String,
}

/// The answer is yes.
pub(crate) const DONE: u8 = 0;
/// The answer is no, or there is none since the command was stopped.
pub(crate) const NO: u8 = 1;
/// The request is invalid.
pub(crate) const WRONG_INPUT: u8 = 2;
/// Something could not be written.
const NOT_WRITTEN: u8 = 3;

impl Failure {
    /// The request is invalid.
    pub(crate) fn wrong_input(text: impl Into<String>) -> Failure {
        Failure { status: WRONG_INPUT, text: text.into(), json: String::new() }
    }

    /// The command was stopped before it had an answer.
    pub(crate) fn stopped(message: &str) -> Failure {
        Failure { status: NO, text: message.to_string(), json: String::new() }
    }

    /// The request is valid, but something could not be written.
    pub(crate) fn not_written(message: &str) -> Failure {
        Failure { status: NOT_WRITTEN, text: format!("error: {message}"), json: String::new() }
    }

    pub(crate) fn with_json(self, json: String) -> Failure {
        Failure { json, ..self }
    }
}
