//! Tables of recorded numbers: text from loggers and spreadsheets, and Apache Parquet.
//!
//! ```text
//! bytes, required signals -> MeasuredTable: headings, rows -> columns: signals and units -> numbers in SI
//! ```
//!
//! One reader for everything that is measured: static tests of a valve, frequency responses,
//! signals of a scenario. In text, the reader finds the separator and the row that names the
//! columns, wherever it is; a unit is in a heading or below it; a decimal sign is a point or a
//! comma, one of them in a whole file. Rows without any value and rows that begin with `#` are
//! ignored. Times are numbers, or stamps of a clock, which are read as seconds since the first one.

mod cell;
mod clock;
mod column;
mod decode;
mod error;
mod faults;
mod gauge;
mod heading;
mod labview;
mod layout;
mod parquet;
mod text;
mod thousands;
mod times;

pub use column::{Column, Measurand, Sought, TIME_NAMES, TIMES};
pub(crate) use times::{median_step, not_increasing};

use self::error::{RowError, TableHint};
use self::parquet::ParquetRows;
use self::text::TextRows;
use crate::project::{Findings, Place, RawFinding};

/// Headings and the rows below them. The text belongs to the findings with which it was read.
pub struct MeasuredTable {
    /// Heading of each column.
    pub headings: Vec<Heading>,
    rows: TableRows,
    /// Rows below the headings that contain no number and no unit.
    left_out: Vec<Place>,
}

enum TableRows {
    Text(TextRows),
    Parquet(ParquetRows),
}

/// Heading of a column.
#[derive(Clone, Debug, PartialEq)]
pub struct Heading {
    /// Text as written.
    pub text: String,
    /// Place in the file.
    pub place: Place,
    /// Unit from the row of units, or from the type of the column.
    unit: Option<String>,
}

/// Numbers of columns, row by row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColumnNumbers {
    /// Values of each column, SI; NaN in a gap, and at an error.
    pub columns: Vec<Vec<f64>>,
    /// Rows without a value, for each column: empty, or a word such as `NaN`.
    pub gaps: Vec<Vec<usize>>,
    /// Index of the last row, if it has fewer values than there are columns; its values are
    /// omitted.
    pub cut_off: Option<usize>,
}

impl MeasuredTable {
    /// Reads a file. `separator` is that of a text; absent, it is found.
    ///
    /// # Errors
    /// `None` for a file that is not a table, with the reason among the findings.
    pub fn read(
        file: &str,
        bytes: Vec<u8>,
        sought: &[Sought<'_>],
        separator: Option<char>,
        findings: &mut Findings,
    ) -> Option<MeasuredTable> {
        if bytes.starts_with(parquet::MAGIC) {
            let (headings, rows) = parquet::open(file, bytes, findings)?;
            return Some(MeasuredTable { headings, rows: TableRows::Parquet(rows), left_out: Vec::new() });
        }
        let (content, skipped) = decode::text(file, bytes, findings)?;
        let text = findings.add_text(file, content, skipped);
        let (headings, rows, left_out) = match text::open(text, findings.content(text), sought, separator) {
            Ok(table) => table,
            Err(found) => {
                findings.push(found);
                return None;
            }
        };
        Some(MeasuredTable { headings, rows: TableRows::Text(rows), left_out })
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        match &self.rows {
            TableRows::Text(rows) => rows.count(),
            TableRows::Parquet(rows) => rows.count,
        }
    }

    /// Rows below the headings that contain neither numbers nor units.
    pub fn left_out(&self) -> &[Place] {
        &self.left_out
    }

    /// Place of the row that names the columns.
    pub(crate) fn header_place(&self) -> Place {
        let ends = self.headings.first().zip(self.headings.last());
        ends.map_or(Place::default(), |(first, last)| Place { end: last.place.end, ..first.place })
    }

    /// Numbers of these columns, with the opposite sign if a column is reversed. Text that is not a
    /// number is an error, and so is a row with more or fewer values than there are columns; gaps
    /// and an incomplete last row are reported in the result.
    pub fn numbers(&self, columns: &[&Column], findings: &mut Findings) -> ColumnNumbers {
        let mut numbers = match &self.rows {
            TableRows::Text(rows) => {
                let (numbers, found) =
                    rows.numbers(findings.content(rows.text), self.headings.len(), columns);
                found.into_iter().for_each(|found| findings.push(found));
                numbers
            }
            TableRows::Parquet(rows) => rows.numbers(&self.headings, columns, findings),
        };
        let reversed = columns.iter().zip(&mut numbers.columns).filter(|(column, _)| column.is_reversed);
        // zero stays zero, without a sign
        reversed.for_each(|(_, values)| values.iter_mut().for_each(|value| *value = 0.0 - *value));
        numbers
    }

    /// Numbers of these columns, where nothing may be missing: gaps, an incomplete last row and
    /// rows without a number are errors too, each with NaN among the numbers.
    pub(crate) fn all_numbers(&self, columns: &[&Column], findings: &mut Findings) -> Vec<Vec<f64>> {
        for place in &self.left_out {
            findings.push(
                RawFinding::error(*place, RowError::NoNumber.to_string())
                    .expected(TableHint::NumberInEachColumn.to_string()),
            );
        }
        let numbers = self.numbers(columns, findings);
        if let Some(row) = numbers.cut_off {
            findings.push(self.incomplete(row, findings));
        }
        for (column, gaps) in columns.iter().zip(&numbers.gaps) {
            for row in gaps {
                let message = match self.cell(*row, column, findings) {
                    "" => RowError::NoValue,
                    text => RowError::NotANumber(text.to_string()),
                };
                let found = self.error(*row, column, message.to_string(), findings);
                findings.push(found.expected(column.expected()));
            }
        }
        numbers.columns
    }

    /// A finding at a value.
    pub fn error(
        &self,
        row: usize,
        column: &Column,
        message: impl Into<String>,
        findings: &Findings,
    ) -> RawFinding {
        let message = message.into();
        match &self.rows {
            TableRows::Text(rows) => {
                RawFinding::error(rows.place(findings.content(rows.text), row, column.index), message)
            }
            TableRows::Parquet(rows) => {
                let at = parquet::number_of(row, self.heading(column));
                RawFinding::error(rows.place(row), format!("{at}: {message}"))
            }
        }
    }

    /// A finding about several rows, at the first of them.
    pub fn warning(&self, rows: &[usize], column: &Column, message: &str, findings: &Findings) -> RawFinding {
        let place = match (&self.rows, rows.first()) {
            (TableRows::Text(text), Some(row)) => text.place(findings.content(text.text), *row, column.index),
            (TableRows::Parquet(parquet), Some(row)) => parquet.place(*row),
            (_, None) => self.header_place(),
        };
        RawFinding::warning(place, format!("{message}: {}", self.names_of(rows, findings)))
    }

    /// Text of a cell; empty in Parquet.
    pub fn cell<'f>(&self, row: usize, column: &Column, findings: &'f Findings) -> &'f str {
        let TableRows::Text(rows) = &self.rows else { return "" };
        let place = rows.place(findings.content(rows.text), row, column.index);
        findings.content(rows.text).get(place.start..place.end).unwrap_or_default()
    }

    /// True if the first value of a column is a stamp of a clock.
    fn is_clock(&self, index: usize, findings: &Findings) -> bool {
        let TableRows::Text(rows) = &self.rows else { return false };
        let content = findings.content(rows.text);
        let place = rows.place(content, 0, index);
        let first = content.get(place.start..place.end).unwrap_or_default();
        clock::ClockStamp::read(first).is_some()
    }

    /// Heading of a column, as written.
    pub fn heading(&self, column: &Column) -> &str {
        self.headings.get(column.index).map_or("", |heading| &heading.text)
    }

    /// Releases the memory of the text, unless it has findings: no further ones will follow.
    pub fn close(self, findings: &mut Findings) {
        if let TableRows::Text(rows) = &self.rows {
            findings.release(rows.text);
        }
    }

    fn incomplete(&self, row: usize, findings: &Findings) -> RawFinding {
        match &self.rows {
            TableRows::Text(rows) => rows.incomplete(findings.content(rows.text), row, self.headings.len()),
            TableRows::Parquet(rows) => {
                RawFinding::error(rows.place(row), RowError::Incomplete(row + 1).to_string())
            }
        }
    }

    /// Row numbers as in an editor, consecutive ones shortened.
    fn names_of(&self, rows: &[usize], findings: &Findings) -> String {
        let number = |row: usize| match &self.rows {
            TableRows::Text(text) => text.line(findings.content(text.text), row),
            TableRows::Parquet(_) => row + 1,
        };
        let word = if matches!(self.rows, TableRows::Text(_)) { "line" } else { "row" };
        let mut runs: Vec<[usize; 2]> = Vec::new();
        for row in rows {
            match runs.last_mut() {
                Some([_, last]) if *row == *last + 1 => *last = *row,
                _ => runs.push([*row, *row]),
            }
        }
        let named = |[first, last]: &[usize; 2]| match last - first {
            0 => format!("{}", number(*first)),
            1 => format!("{}, {}", number(*first), number(*last)),
            _ => format!("{} to {}", number(*first), number(*last)),
        };
        let listed = runs.iter().take(MOST_LISTED).map(named).collect::<Vec<_>>().join(", ");
        let rest: usize = runs.iter().skip(MOST_LISTED).map(|[first, last]| last - first + 1).sum();
        let plural = if rows.len() == 1 { "" } else { "s" };
        let more = if rest == 0 { String::new() } else { format!(" and {rest} more") };
        format!("{word}{plural} {listed}{more}")
    }
}

/// Largest number of consecutive ranges of rows in a message.
const MOST_LISTED: usize = 8;
