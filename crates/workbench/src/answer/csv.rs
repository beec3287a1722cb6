//! Small tables for other programs.

use std::fmt::Display;

use super::OutputFile;

/// Comma-separated values below their headings.
pub(crate) struct Csv(String);

impl Csv {
    /// An empty table with these headings, which are separated by commas.
    pub(crate) fn new(headings: &str) -> Csv {
        Csv(format!("{headings}\n"))
    }

    /// A row.
    pub(crate) fn row(&mut self, values: &[&dyn Display]) {
        let values: Vec<String> = values.iter().map(ToString::to_string).collect();
        self.0.push_str(&values.join(","));
        self.0.push('\n');
    }

    /// The table as a file.
    pub(crate) fn file(self, name: &str) -> OutputFile {
        OutputFile::new(name, self.0)
    }
}

/// A text that may have commas in it, as one value.
pub(crate) fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}
