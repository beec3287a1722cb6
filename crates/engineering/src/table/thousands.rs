//! Detection of signs between thousands, in a column of whole numbers.

use super::cell::TextCell;
use super::column::Column;
use super::error::{ColumnError, TableHint};
use crate::project::{Place, RawFinding};

/// Notation of the numbers of a column, as long as `1.004` may be a thousand and four.
#[derive(Clone, Default)]
pub(super) struct ThousandsSigns {
    /// True once a number is neither whole and below 1000 nor like `1.004`.
    is_excluded: bool,
    has_three_digits: bool,
    count: usize,
    /// First number with a sign: its text and its place.
    first: Option<(String, usize)>,
    /// Number of the row before, and true if it has a sign.
    before: Option<(f64, bool)>,
    /// Numbers of neighbours, one of which has a sign, that are closer as thousands, and closer as
    /// decimals.
    closer: [usize; 2],
}

impl ThousandsSigns {
    /// Adds the number of the next row.
    pub(super) fn take(&mut self, cell: TextCell<'_>) {
        if self.is_excluded {
            return;
        }
        let digits = cell.text.trim_start_matches(['-', '+']);
        let (head, tail) =
            digits.split_once(['.', ',']).map_or((digits, None), |(head, tail)| (head, Some(tail)));
        let are_digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
        let is_group = tail.is_none_or(|tail| tail.len() == 3 && are_digits(tail) && !head.starts_with('0'));
        let number = cell.text.replace(',', ".").parse::<f64>();
        let (Ok(number), true) = (number, is_group && (1..=3).contains(&head.len()) && are_digits(head))
        else {
            self.is_excluded = true;
            return;
        };
        match tail {
            None => self.has_three_digits |= head.len() == 3,
            Some(_) => {
                self.count += 1;
                self.first.get_or_insert_with(|| (cell.text.to_string(), cell.start));
            }
        }
        if let Some((before, had_sign)) = self.before.filter(|(_, had_sign)| *had_sign != tail.is_some()) {
            let (group, whole) = if had_sign { (before, number) } else { (number, before) };
            let is_thousand = (1000.0 * group - whole).abs() < (group - whole).abs();
            let [thousands, decimals] = &mut self.closer;
            *(if is_thousand { thousands } else { decimals }) += 1;
        }
        self.before = Some((number, tail.is_some()));
    }

    /// Error for numbers of a column that continue their whole neighbours beyond 999.
    pub(super) fn finding(self, text: usize, column: &Column) -> Option<RawFinding> {
        let [thousands, decimals] = self.closer;
        if self.is_excluded || !self.has_three_digits || thousands <= decimals {
            return None;
        }
        let (number, start) = self.first?;
        let place = Place { text, start, end: start + number.len() };
        let without_sign = number.replace(['.', ','], "");
        let message = ColumnError::SignBetweenThousands { number, without_sign, rows: self.count };
        let found = RawFinding::error(place, message.to_string()).expected(column.expected());
        Some(found.help(TableHint::NoThousandsSigns.to_string()))
    }
}
