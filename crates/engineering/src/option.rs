//! Errors of command-line options.

/// An invalid value of an option.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("--{option} {text}: {message}")]
pub struct OptionError {
    /// Name of the option.
    pub option: &'static str,
    /// Text as written.
    pub text: String,
    /// Fault of the value.
    pub message: String,
}
