//! A text of rows and cells, whatever separates them.

use crate::family::measured::table::MeasuredCell as Cell;
use crate::project::{Findings, Place, RawFinding};

use super::column::stem_of;

/// Rows below the names of their columns.
pub(super) struct Sheet<'a> {
    /// Names of the columns.
    pub(super) header: Vec<Cell<'a>>,
    /// A row of units, where there is one.
    pub(super) units: Option<Vec<Cell<'a>>>,
    /// All rows below.
    pub(super) rows: Vec<Vec<Cell<'a>>>,
    /// Whether a comma is a decimal sign.
    pub(super) decimal_comma: bool,
}

impl<'a> Sheet<'a> {
    /// Takes a file in; `None` where it is no text, or no row names columns.
    pub(super) fn read(path: &str, bytes: &'a [u8], findings: &mut Findings) -> Option<Sheet<'a>> {
        let skipped = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        let Ok(content) = std::str::from_utf8(bytes.get(skipped..).unwrap_or_default()) else {
            findings.unreadable(path, "the file is no UTF-8 text");
            return None;
        };
        let index = findings.add_text(path, content, skipped);
        let mut start = 0;
        let mut lines = Vec::new();
        for line in content.split_inclusive('\n') {
            if !line.trim().is_empty() && !line.trim_start().starts_with('#') {
                lines.push((line, start));
            }
            start += line.len();
        }
        for (number, (line, start)) in lines.iter().enumerate() {
            // a semicolon or a tab in the names separates columns; otherwise a comma does
            let separator = [';', '\t'].into_iter().find(|sign| line.contains(*sign)).unwrap_or(',');
            let header = cells(line, *start, index, separator);
            if !header.iter().any(|cell| stem_of(cell.text).is_some()) {
                continue;
            }
            let below = lines.get(number + 1..).unwrap_or_default();
            let mut rows: Vec<Vec<Cell<'_>>> =
                below.iter().map(|(line, start)| cells(line, *start, index, separator)).collect();
            let is_number = |cell: &Cell<'_>| number_of(cell.text, separator != ',').is_some();
            let names_units = rows.first().is_some_and(|row| !row.iter().any(is_number));
            let units = names_units.then(|| rows.remove(0));
            return Some(Sheet { header, units, rows, decimal_comma: separator != ',' });
        }
        let place = Place { text: index, start: 0, end: 0 };
        let found = RawFinding::error(place, "no row has the names of columns");
        findings.push(found.expected("a row such as `time_s,command_v,supply_pressure_bar,pressure_a_bar`"));
        None
    }

    /// Where the columns are named.
    pub(super) fn header_place(&self) -> Place {
        let ends = self.header.first().zip(self.header.last());
        ends.map_or(Place::default(), |(first, last)| Place { end: last.place.end, ..first.place })
    }

    /// Whether a row has a value for every column and no more.
    pub(super) fn is_complete(&self, row: &[Cell<'_>], findings: &mut Findings) -> bool {
        let (Some(first), Some(last)) = (row.first(), row.last()) else { return false };
        if row.len() == self.header.len() {
            return true;
        }
        let place = Place { end: last.place.end, ..first.place };
        let found =
            RawFinding::error(place, format!("{} values for {} columns", row.len(), self.header.len()));
        findings.push(match self.decimal_comma {
            true => found,
            false => found.help("where the decimal sign is a comma, separate values with semicolons or tabs"),
        });
        false
    }

    /// The number in a cell.
    pub(super) fn number(&self, cell: &Cell<'_>) -> Option<f64> {
        number_of(cell.text, self.decimal_comma)
    }
}

/// A finite number with a point, or a comma where that is allowed.
fn number_of(text: &str, decimal_comma: bool) -> Option<f64> {
    let with_point = if decimal_comma { text.replace(',', ".") } else { text.to_string() };
    with_point.parse().ok().filter(|value: &f64| value.is_finite())
}

/// The values of a line that starts at a byte of its text.
fn cells(line: &str, start: usize, index: usize, separator: char) -> Vec<Cell<'_>> {
    let mut from = start;
    let cell = |part: &'_ str| -> (usize, usize) {
        let trimmed = part.trim();
        let text = trimmed.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')).unwrap_or(trimmed);
        let first = text.as_ptr() as usize - part.as_ptr() as usize;
        (first, first + text.len())
    };
    let mut found = Vec::new();
    for part in line.trim_end_matches(['\r', '\n']).split(separator) {
        let (first, end) = cell(part);
        let text = part.get(first..end).unwrap_or_default();
        found.push(Cell { text, place: Place { text: index, start: from + first, end: from + end } });
        from += part.len() + separator.len_utf8();
    }
    found
}
