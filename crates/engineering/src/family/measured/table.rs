//! A text of rows and columns whose every value knows where it is written.

use crate::project::{Findings, Place, RawFinding};

/// A value as written.
#[derive(Clone, Copy, Debug)]
pub struct MeasuredCell<'a> {
    /// As written.
    pub text: &'a str,
    /// Where.
    pub place: Place,
}

/// The first row, and all others.
pub struct MeasuredTable<'a> {
    /// Names of the columns.
    pub header: Vec<MeasuredCell<'a>>,
    /// All rows below.
    pub rows: Vec<Vec<MeasuredCell<'a>>>,
}

/// Takes a file in; `None` if it is no text or has no rows.
pub fn read<'a>(path: &str, bytes: &'a [u8], findings: &mut Findings) -> Option<MeasuredTable<'a>> {
    let skipped = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
    let Ok(content) = std::str::from_utf8(&bytes[skipped..]) else {
        findings.unreadable(path, "the file is no UTF-8 text");
        return None;
    };
    let index = findings.add_text(path, content, skipped);
    let mut start = 0;
    let mut rows = Vec::new();
    for line in content.split_inclusive('\n') {
        let text = line.trim();
        if !text.is_empty() && !text.starts_with('#') {
            rows.push(cells(line, start, index));
        }
        start += line.len();
    }
    let mut rows = rows.into_iter();
    let whole = Place { text: index, start: 0, end: 0 };
    let Some(header) = rows.next() else {
        findings.push(
            RawFinding::error(whole, "the file is empty").expected("a row with the names of the columns"),
        );
        return None;
    };
    let rows: Vec<Vec<MeasuredCell<'_>>> = rows.collect();
    if rows.is_empty() {
        findings.push(RawFinding::error(whole, "the file has no rows below the names of its columns"));
        return None;
    }
    Some(MeasuredTable { header, rows })
}

/// The values of a line that starts at a byte of its text.
fn cells(line: &str, start: usize, index: usize) -> Vec<MeasuredCell<'_>> {
    let mut from = start;
    let cell = |part| {
        let text = unquoted(part);
        let first = from + (text.as_ptr() as usize - part.as_ptr() as usize);
        from += part.len() + 1;
        MeasuredCell { text, place: Place { text: index, start: first, end: first + text.len() } }
    };
    line.trim_end().split(',').map(cell).collect()
}

/// Without spaces and one pair of quotes around it.
fn unquoted(part: &str) -> &str {
    let text = part.trim();
    text.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')).map_or(text, str::trim)
}

impl MeasuredTable<'_> {
    /// Whether a row has a value for every column and no more.
    pub fn is_complete(&self, row: &[MeasuredCell<'_>], findings: &mut Findings) -> bool {
        let (Some(first), Some(last)) = (row.first(), row.last()) else { return false };
        let columns = self.header.len();
        if row.len() == columns {
            return true;
        }
        let place = Place { end: last.place.end, ..first.place };
        let counted =
            |count: usize| if count == 1 { "one value".to_string() } else { format!("{count} values") };
        let found = RawFinding::error(place, format!("{} for {columns} columns", counted(row.len())));
        findings.push(match row.len() > columns {
            true => found.help("write the decimal sign as a point"),
            false => found.help("separate values with commas, and write the decimal sign as a point"),
        });
        false
    }
}
