//! Why the value of an option of the command line is invalid.

/// A value of an option that is invalid.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("--{option} {text}: {message}")]
pub struct OptionError {
    /// Name of the option.
    pub option: &'static str,
    /// As written.
    pub text: String,
    /// What is wrong with it.
    pub message: String,
}
