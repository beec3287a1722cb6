//! What is wrong with a file, where, and what would be right.

use std::ops::Range;

/// One finding in a file or setting.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Whether it refuses the file.
    pub severity: Severity,
    /// What is wrong, in one sentence.
    pub message: String,
    /// The file, or `--set` and its text.
    pub file: String,
    /// From 1; 0 where the file itself is meant.
    pub line: usize,
    /// In characters, from 1; 0 where the file itself is meant.
    pub column: usize,
    /// In bytes of the file.
    pub span: Range<usize>,
    /// What was expected there.
    pub expected: Option<String>,
    /// The nearest valid name, or what to do.
    pub help: Option<String>,
}

/// Whether a finding refuses the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The file is refused.
    Error,
    /// The file is taken as it is.
    Warning,
}

/// Why a project was refused: every finding of one run, and the texts they point into.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// Errors first, each in file order.
    pub diagnostics: Vec<Diagnostic>,
    /// Name and content of every text a diagnostic points into.
    pub texts: Vec<(String, String)>,
}
