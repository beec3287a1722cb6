//! Contents of files, as they were read.

use super::recording::Recording;
use crate::project::{Diagnostic, StaticTest, TestSignal};

/// Tests of some files, and facts about the files.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecordedFiles {
    /// The tests, in the order of the files.
    pub recordings: Vec<Recording>,
    /// Contents of each file.
    pub contents: Vec<FileContents>,
    /// Findings in the accepted files.
    pub warnings: Vec<Diagnostic>,
}

/// Contents of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct FileContents {
    /// Path of the file.
    pub file: String,
    /// Kind of the test, if the project states it.
    pub test: Option<StaticTest>,
    /// Number of rows that are used.
    pub rows: usize,
    /// Number of rows that are omitted, each with a warning.
    pub rows_left_out: usize,
    /// Columns that are used.
    pub columns: Vec<ColumnContents>,
    /// Headings of unused columns.
    pub unused: Vec<String>,
}

/// A used column and its meaning.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnContents {
    /// Heading of the column.
    pub heading: String,
    /// Signal in the column.
    pub signal: TestSignal,
    /// Unit in which the column was read.
    pub unit: String,
    /// True if the column was read with the opposite sign, as the project states.
    pub is_reversed: bool,
    /// Least and greatest value of the used rows, SI.
    pub range: [f64; 2],
    /// Number of rows without a value.
    pub gaps: usize,
}
