//! Warnings on recorded files.

use super::Answer;

/// Warning on a recorded file.
#[derive(Answer)]
pub(crate) struct FileWarningAnswer {
    /// Sentence on the finding.
    pub(crate) message: String,
    /// Path of the file.
    pub(crate) file: String,
    /// Line of the file, from 1, if one is concerned.
    #[answer(optional)]
    pub(crate) line: Option<usize>,
    /// Column of the line, from 1, if one is concerned.
    #[answer(optional)]
    pub(crate) column: Option<usize>,
}

impl FileWarningAnswer {
    /// Warning on a whole file.
    pub(crate) fn of_file(message: String, file: &str) -> FileWarningAnswer {
        FileWarningAnswer { message, file: file.to_string(), line: None, column: None }
    }
}
