//! Text with commas, for other programs: the one writer of it.
//!
//! The crate `csv` (1.4) would not shorten it. It quotes a cell for what is in it, and these tables
//! quote texts always, names and numbers never; its numbers have other digits, so that it would be
//! handed texts. What it would do is what [`Csv::cell`] and [`Csv::end_row`] do.

use std::fmt::{Display, Write as _};

/// Rows that grow cell by cell.
///
/// # Example
/// ```
/// use phea_engineering::csv::{Csv, quoted};
/// let mut csv = Csv::new("name,value");
/// csv.row(&[&quoted("a, \"b\""), &1.5]);
/// assert_eq!(csv.text(), "name,value\n\"a, \"\"b\"\"\",1.5\n");
/// ```
#[derive(Clone, Debug, Default)]
pub struct Csv {
    text: String,
    is_within_row: bool,
}

impl Csv {
    /// Below these headings, which are separated by commas.
    pub fn new(headings: &str) -> Csv {
        Csv { text: format!("{headings}\n"), is_within_row: false }
    }

    /// The text to which the next cell of the row is written.
    pub fn cell(&mut self) -> &mut String {
        if std::mem::replace(&mut self.is_within_row, true) {
            self.text.push(',');
        }
        &mut self.text
    }

    /// Ends the row.
    pub fn end_row(&mut self) {
        self.text.push('\n');
        self.is_within_row = false;
    }

    /// Adds cells to the row.
    pub fn cells(&mut self, values: &[&dyn Display]) {
        for value in values {
            // writing to memory cannot fail
            let _ = write!(self.cell(), "{value}");
        }
    }

    /// A row.
    pub fn row(&mut self, values: &[&dyn Display]) {
        self.cells(values);
        self.end_row();
    }

    /// All of it so far.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Removes all of it.
    pub fn clear(&mut self) {
        self.text.clear();
        self.is_within_row = false;
    }
}

/// A text that may have commas in it, as one cell.
pub fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}
