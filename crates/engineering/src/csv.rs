//! Text with commas, for other programs: the only writer of this format.
//!
//! The crate `csv` (1.4) would not shorten it. It quotes a cell depending on its content, whereas
//! these tables always quote texts, and never names and numbers; it prints numbers with other
//! digits, so that it would need them as text. The rest of its work is done by [`Csv::cell`] and
//! [`Csv::end_row`].

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
    /// Rows below these headings, which are separated by commas.
    pub fn new(headings: &str) -> Csv {
        Csv { text: format!("{headings}\n"), is_within_row: false }
    }

    /// Text to which the next cell of the row is written.
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

    /// Adds a row.
    pub fn row(&mut self, values: &[&dyn Display]) {
        self.cells(values);
        self.end_row();
    }

    /// Text of all rows so far.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Removes all rows.
    pub fn clear(&mut self) {
        self.text.clear();
        self.is_within_row = false;
    }
}

/// Cell with a text that may contain commas.
pub fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}
