//! Failure of a command, and its exit status.

/// Reason why there is no answer, or why not all of it was written.
#[derive(Debug)]
pub(crate) struct Failure {
    pub(crate) status: u8,
    /// Text for people.
    pub(crate) text: String,
    /// JSON object, if requested; otherwise empty.
    pub(crate) json: String,
}

/// Exit status if the answer is yes.
pub(crate) const DONE: u8 = 0;
/// Exit status if the answer is no, or there is none because the command was stopped.
pub(crate) const NO: u8 = 1;
/// Exit status of an invalid request.
pub(crate) const WRONG_INPUT: u8 = 2;
/// Exit status if something could not be written.
const NOT_WRITTEN: u8 = 3;

impl Failure {
    /// Failure of an invalid request.
    pub(crate) fn wrong_input(text: impl Into<String>) -> Failure {
        Failure { status: WRONG_INPUT, text: text.into(), json: String::new() }
    }

    /// Failure of a command that was stopped before it had an answer.
    pub(crate) fn stopped(message: &str) -> Failure {
        Failure { status: NO, text: message.to_string(), json: String::new() }
    }

    /// Failure of a valid request whose result could not be written.
    pub(crate) fn not_written(message: &str) -> Failure {
        Failure { status: NOT_WRITTEN, text: format!("error: {message}"), json: String::new() }
    }

    pub(crate) fn with_json(self, json: String) -> Failure {
        Failure { json, ..self }
    }
}
