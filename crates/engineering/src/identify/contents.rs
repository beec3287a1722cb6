//! Contents of files, as they were read.

use super::recording::Recording;
use crate::project::{Diagnostic, StaticTest, TestSignal};

/// The tests of some files, and what to know of the files.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecordedFiles {
    /// The tests, in the order of the files.
    pub recordings: Vec<Recording>,
    /// Contents of each file.
    pub contents: Vec<FileContents>,
    /// Findings in the files that were not refused.
    pub warnings: Vec<Diagnostic>,
}

/// Contents of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct FileContents {
    /// Path of the file.
    pub file: String,
    /// Which test it is, where the project says so.
    pub test: Option<StaticTest>,
    /// Rows that are used.
    pub rows: usize,
    /// Rows that are left out, each with a warning.
    pub rows_left_out: usize,
    /// Columns that are used.
    pub columns: Vec<ColumnContents>,
    /// Headings of columns that are not.
    pub unused: Vec<String>,
}

/// A column that is used, and what it was taken for.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnContents {
    /// Its heading.
    pub heading: String,
    /// Signal that it holds.
    pub signal: TestSignal,
    /// The unit that it was read in.
    pub unit: String,
    /// True where it was read with the opposite sign, as the project says.
    pub is_reversed: bool,
    /// Least and greatest value of the rows that are used, in SI.
    pub range: [f64; 2],
    /// Rows without a value.
    pub gaps: usize,
}
