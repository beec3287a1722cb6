//! Reader of a table in text form.

use super::cell::{Cells, Separator};
use super::clock::ClockReading;
use super::column::{Column, Sought};
use super::error::{MeasuredTableError, RowError, TableHint};
use super::faults::Faults;
use super::heading::{bare, unit_meant};
use super::labview;
use super::layout::{self, is_row, lines};
use super::thousands::ThousandsSigns;
use super::{ColumnNumbers, Heading};
use crate::project::{Place, RawFinding};
use crate::spelling::nearest;

/// The rows of a text.
pub(super) struct TextRows {
    /// Index among the texts of the findings.
    pub(super) text: usize,
    separator: Separator,
    /// First byte of each row.
    starts: Vec<usize>,
}

/// Largest number of rows without a number between the names and the rows.
const MOST_BELOW: usize = 20;

/// Headings, rows, and rows that are neither.
type Opened = (Vec<Heading>, TextRows, Vec<Place>);

pub(super) fn open(
    text: usize,
    content: &str,
    sought: &[Sought<'_>],
    separator: Option<char>,
) -> Result<Opened, RawFinding> {
    let separator = separator.map(|sign| match sign {
        ' ' => Separator::Spaces,
        sign => Separator::Sign(u8::try_from(sign).unwrap_or(b',')),
    });
    labview::refuse_chart(text, content)?;
    let (layout, units) = match labview::header(text, content).transpose()? {
        Some(header) => (Some(header.layout), header.units),
        None => (layout::find(content, sought, separator), Vec::new()),
    };
    let Some(layout) = layout else { return Err(unnamed(text, content, sought)) };
    let separator = layout.separator;
    let mut cells = Cells::new(content, layout.header, separator);
    let mut headings: Vec<Heading> = cells
        .by_ref()
        .map(|cell| Heading { text: cell.text.to_string(), place: cell.place(text), unit: None })
        .collect();
    headings.iter_mut().zip(units).for_each(|(heading, unit)| heading.unit = Some(unit));
    let below = cells.at;
    let mut starts = starts(content, below, separator);
    let mut left_out = Vec::new();
    let is_number =
        |start: &usize| Cells::new(content, *start, separator).any(|cell| is_like_number(cell.text));
    let first = starts.iter().take(MOST_BELOW).position(is_number).unwrap_or(0);
    for start in starts.drain(..first) {
        let row: Vec<_> = Cells::new(content, start, separator).collect();
        let is_unit = |cell: &super::cell::TextCell<'_>| {
            sought.iter().any(|one| unit_meant(bare(cell.text), one.measurand.dimension).is_some())
        };
        if headings.iter().all(|heading| heading.unit.is_none()) && row.iter().any(is_unit) {
            headings
                .iter_mut()
                .zip(&row)
                .for_each(|(heading, cell)| heading.unit = Some(cell.text.to_string()));
        } else {
            let end = row.last().map_or(start, |cell| cell.start + cell.text.len());
            left_out.push(Place { text, start, end });
        }
    }
    if starts.is_empty() {
        let place = Place { text, start: 0, end: 0 };
        return Err(RawFinding::error(place, MeasuredTableError::NothingBelowNames.to_string()));
    }
    Ok((headings, TextRows { text, separator, starts }, left_out))
}

/// Error for a text without a row of names, with the closest spelling.
fn unnamed(text: usize, content: &str, sought: &[Sought<'_>]) -> RawFinding {
    let names: Vec<String> = sought.iter().flat_map(Sought::usual_names).collect();
    let mut rows = lines(content, 0).filter(|(line, _)| is_row(line, Separator::Spaces));
    let Some((first, start)) = rows.next() else {
        let found =
            RawFinding::error(Place { text, start: 0, end: 0 }, MeasuredTableError::Empty.to_string());
        return found.expected(TableHint::RowOfNames.to_string());
    };
    let words = first.split([',', ';', '\t', '|']).map(|word| word.trim().trim_matches('"'));
    let near = words
        .filter(|word| word.len() > 1)
        .find_map(|word| Some((word, nearest(word, names.iter().map(String::as_str))?)));
    let place = Place { text, start, end: start + first.trim_end().len() };
    let example: Vec<&str> = sought.iter().filter_map(|one| names_first(one, &names)).take(3).collect();
    let found = RawFinding::error(place, MeasuredTableError::NoNames.to_string())
        .expected(TableHint::NamesSuchAs(example.join(", ")).to_string());
    let near =
        near.map(|(word, near)| TableHint::NearWord { word: word.to_string(), near: near.to_string() });
    found.help(near.unwrap_or(TableHint::HeadingsInProject).to_string())
}

/// First usual name of a required signal.
fn names_first<'n>(sought: &Sought<'_>, names: &'n [String]) -> Option<&'n str> {
    let first = sought.usual_names().into_iter().next()?;
    names.iter().find(|name| **name == first).map(String::as_str)
}

/// First bytes of all rows after a given byte.
fn starts(content: &str, below: usize, separator: Separator) -> Vec<usize> {
    let has_quotes = content.get(below..).is_some_and(|rest| rest.contains('"'));
    let mut starts = Vec::new();
    let mut until = below;
    for (line, start) in lines(content, below) {
        // a value in quotes may continue on the next line
        if start < until || !is_row(line, separator) {
            continue;
        }
        starts.push(start);
        if has_quotes && line.contains('"') {
            until = Cells::new(content, start, separator).end();
        }
    }
    starts
}

fn is_like_number(text: &str) -> bool {
    !text.is_empty() && (text.replace(',', ".").parse::<f64>().is_ok() || is_gap(text))
}

/// True for text that loggers and spreadsheets write in place of a missing value.
fn is_gap(text: &str) -> bool {
    let words = ["", "nan", "na", "n/a", "#n/a", "null", "none", "-", "--", "-nan", "1.#qnan", "-1.#ind"];
    words.iter().any(|word| text.eq_ignore_ascii_case(word))
}

impl TextRows {
    pub(super) fn count(&self) -> usize {
        self.starts.len()
    }

    fn cells<'c>(&self, content: &'c str, row: usize) -> Cells<'c> {
        Cells::new(content, self.starts.get(row).copied().unwrap_or(content.len()), self.separator)
    }

    /// Place of a value; the end of the row if it has none.
    pub(super) fn place(&self, content: &str, row: usize, index: usize) -> Place {
        let mut cells = self.cells(content, row);
        let found = cells.by_ref().nth(index);
        found.map_or(Place { text: self.text, start: cells.at, end: cells.at }, |cell| cell.place(self.text))
    }

    /// Line number of a row, from 1.
    pub(super) fn line(&self, content: &str, row: usize) -> usize {
        let start = self.starts.get(row).copied().unwrap_or(content.len());
        content.bytes().take(start).filter(|byte| *byte == b'\n').count() + 1
    }

    /// Error for a row with more or fewer values than there are columns.
    pub(super) fn incomplete(&self, content: &str, row: usize, columns: usize) -> RawFinding {
        let cells: Vec<_> = self.cells(content, row).collect();
        let ends = cells.first().zip(cells.last());
        let place = ends.map_or(Place::default(), |(first, last)| Place {
            text: self.text,
            start: first.start,
            end: last.start + last.text.len(),
        });
        let message = match cells.len() {
            1 => RowError::OneValue { columns },
            values => RowError::OtherCount { values, columns },
        };
        let found = RawFinding::error(place, message.to_string());
        match self.separator {
            Separator::Sign(b',') if cells.len() > columns => {
                found.help(TableHint::SemicolonsOrTabs.to_string())
            }
            _ => found,
        }
    }

    /// Numbers of columns, and their faults.
    pub(super) fn numbers(
        &self,
        content: &str,
        headings: usize,
        columns: &[&Column],
    ) -> (ColumnNumbers, Vec<RawFinding>) {
        let mut slots = vec![None; headings];
        for (slot, column) in columns.iter().enumerate() {
            if let Some(place) = slots.get_mut(column.index) {
                *place = Some((slot, *column));
            }
        }
        let mut reading = TextReading {
            text: self.text,
            numbers: ColumnNumbers {
                columns: vec![Vec::with_capacity(self.starts.len()); columns.len()],
                gaps: vec![Vec::new(); columns.len()],
                cut_off: None,
            },
            incomplete: Faults::default(),
            wrong: vec![Faults::default(); columns.len()],
            clocks: vec![ClockReading::default(); columns.len()],
            signs: vec![ThousandsSigns::default(); columns.len()],
            point: None,
            comma: None,
        };
        for row in 0..self.starts.len() {
            let mut count = 0;
            for (index, cell) in self.cells(content, row).enumerate() {
                match slots.get(index) {
                    Some(Some((slot, column))) => reading.take(row, *slot, column, cell),
                    Some(None) => {}
                    // a separator at the end of a row is not a value
                    None if cell.text.is_empty() => continue,
                    None => {}
                }
                count = index + 1;
            }
            if count < headings && row + 1 == self.starts.len() {
                reading.cut(row);
            } else if count != headings {
                reading.incomplete.add(|| self.incomplete(content, row, headings));
                reading.skip(row);
            }
        }
        let TextReading { numbers, incomplete, wrong, signs, point, comma, .. } = reading;
        let mut found = incomplete.finding(self.starts.len());
        found.extend(wrong.into_iter().flat_map(|wrong| wrong.finding(self.starts.len())));
        let signs = signs.into_iter().zip(columns);
        found.extend(signs.filter_map(|(signs, column)| signs.finding(self.text, column)));
        found.extend(two_signs(content, point, comma));
        (numbers, found)
    }
}

/// Error for a mixture of decimal points and decimal commas.
fn two_signs(content: &str, point: Option<Place>, comma: Option<Place>) -> Option<RawFinding> {
    let (point, comma) = (point?, comma?);
    let text = |place: Place| content.get(place.start..place.end).unwrap_or_default().to_string();
    let message = RowError::TwoDecimalSigns { comma: text(comma), point: text(point) };
    let found = RawFinding::error(comma, message.to_string());
    let found = found.expected(TableHint::OneDecimalSign.to_string());
    Some(found.help(TableHint::NoThousandsSigns.to_string()))
}

/// Error for a text that is not a number.
fn no_number(place: Place, text: &str) -> RawFinding {
    let found = RawFinding::error(place, RowError::NotANumber(text.to_string()).to_string());
    if text.contains('.') && text.contains(',') {
        return found.help(TableHint::NoThousandsSigns.to_string());
    }
    found.maybe_help(text.contains(':').then(|| TableHint::TimesAsSeconds.to_string()))
}

/// State of reading numbers.
struct TextReading {
    text: usize,
    numbers: ColumnNumbers,
    /// Rows with more or fewer values than there are columns.
    incomplete: Faults,
    /// Text that is not a number, for each column.
    wrong: Vec<Faults>,
    /// Decimal and thousands signs of each column.
    signs: Vec<ThousandsSigns>,
    /// Stamps of each column.
    clocks: Vec<ClockReading>,
    /// The first number with a decimal point, and the first with a decimal comma.
    point: Option<Place>,
    comma: Option<Place>,
}

impl TextReading {
    fn take(&mut self, row: usize, slot: usize, column: &Column, cell: super::cell::TextCell<'_>) {
        let is_clock = column.is_time && self.clocks.get(slot).is_some_and(ClockReading::has_begun);
        let value = if is_clock { None } else { column.scale.read(cell.text) };
        if self.point.is_none() && value.is_some() && cell.text.contains('.') {
            self.point = Some(cell.place(self.text));
        }
        if value.is_some()
            && let Some(signs) = self.signs.get_mut(slot)
        {
            signs.take(cell);
        }
        let value = value.unwrap_or_else(|| self.other(row, slot, column, cell));
        if let Some(values) = self.numbers.columns.get_mut(slot) {
            values.push(value);
        }
    }

    /// Value of a cell that is not a number with a point: a number with a comma, a gap, or an
    /// error.
    fn other(&mut self, row: usize, slot: usize, column: &Column, cell: super::cell::TextCell<'_>) -> f64 {
        if is_gap(cell.text) {
            self.numbers.gaps.get_mut(slot).into_iter().for_each(|gaps| gaps.push(row));
            return f64::NAN;
        }
        if let Some(seconds) = self.stamp(slot, column, cell.text) {
            return seconds;
        }
        let is_clock = self.clocks.get(slot).is_some_and(ClockReading::has_begun);
        let has_both = cell.text.contains('.') && cell.text.contains(',');
        if !is_clock
            && !has_both
            && let Some(value) = column.scale.read(&cell.text.replace(',', "."))
        {
            self.comma.get_or_insert(cell.place(self.text));
            self.signs.get_mut(slot).into_iter().for_each(|signs| signs.take(cell));
            return value;
        }
        let place = cell.place(self.text);
        let found = || no_number(place, cell.text).expected(column.expected());
        self.wrong.get_mut(slot).into_iter().for_each(|wrong| wrong.add(found));
        f64::NAN
    }

    /// Time of a stamp, if all values before it are stamps or gaps too.
    fn stamp(&mut self, slot: usize, column: &Column, text: &str) -> Option<f64> {
        let clock = self.clocks.get_mut(slot).filter(|_| column.is_time)?;
        let has_numbers = || self.numbers.columns.get(slot)?.iter().find(|value| !value.is_nan());
        if !clock.has_begun() && has_numbers().is_some() {
            return None;
        }
        clock.seconds(text)
    }

    /// Takes no number of an incomplete row.
    fn skip(&mut self, row: usize) {
        for values in &mut self.numbers.columns {
            values.truncate(row);
            values.push(f64::NAN);
        }
    }

    /// Removes the last row, which is incomplete.
    fn cut(&mut self, row: usize) {
        self.numbers.cut_off = Some(row);
        self.numbers.columns.iter_mut().for_each(|values| values.truncate(row));
        self.numbers.gaps.iter_mut().for_each(|gaps| gaps.retain(|gap| *gap < row));
    }
}
