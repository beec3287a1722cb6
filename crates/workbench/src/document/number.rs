//! The numbers in the cells of tables, as values and as they are printed.

use super::{Block, Cell, Document, Table};
use crate::quantity::{Dimension, DisplayUnit, RATIO, display, significant};

/// Rule for the digits of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Digits {
    /// This many significant digits.
    Significant(usize),
    /// At most this many significant digits, without trailing zeros.
    Shortest(usize),
    /// This many significant digits of the magnitude.
    Magnitude(usize),
    /// Four significant digits without trailing zeros, as for a frequency.
    Frequency,
    /// A signed number, to a hundredth or a thousandth, as for a margin in dB.
    Margin,
    /// This number of decimal places; zero has no sign.
    Decimal(usize),
    /// This number of decimal places, with the sign of positive numbers too.
    Signed(usize),
}

/// Unit of a printed number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum NumberUnit {
    /// The heading has the symbol.
    Heading(DisplayUnit),
    /// The symbol follows the number.
    Symbol(DisplayUnit),
    /// The customary unit for the size of the number follows it.
    Customary(&'static Dimension),
}

/// A number in SI, with the way in which it is printed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CellNumber {
    pub(super) si: f64,
    pub(super) digits: Digits,
    pub(super) unit: NumberUnit,
    /// Magnitude below which the number is printed as zero.
    pub(super) zero_below: f64,
}

impl CellNumber {
    pub(super) fn new(si: f64, digits: Digits, unit: NumberUnit) -> CellNumber {
        CellNumber { si, digits, unit, zero_below: 0.0 }
    }

    pub(super) fn text(&self) -> String {
        let si = if self.si.abs() < self.zero_below { 0.0 } else { self.si };
        match (self.unit, self.digits) {
            (NumberUnit::Customary(dimension), Digits::Significant(digits) | Digits::Shortest(digits)) => {
                display(si, dimension, digits)
            }
            (NumberUnit::Customary(_), digits) => digits.text(si),
            (NumberUnit::Heading(unit), digits) => digits.text(unit.of(si)),
            (NumberUnit::Symbol(unit), Digits::Shortest(digits)) => unit.short(si, digits),
            (NumberUnit::Symbol(unit), digits) => unit.with_symbol(digits.text(unit.of(si))),
        }
    }
}

impl Digits {
    fn text(self, value: f64) -> String {
        match self {
            Digits::Significant(digits) => significant(value, digits),
            Digits::Shortest(digits) => DisplayUnit::ONE.short(value, digits),
            Digits::Magnitude(digits) => significant(value.abs(), digits),
            Digits::Frequency => frequency_number(value),
            Digits::Margin => margin_words(value),
            Digits::Decimal(places) => {
                let text = format!("{value:.places$}");
                let is_zero = text.trim_start_matches('-').trim_matches(['0', '.']).is_empty();
                if is_zero { text.replace('-', "") } else { text }
            }
            Digits::Signed(places) => format!("{value:+.places$}"),
        }
    }
}

/// A number in a table of a document.
#[derive(Clone, Debug, PartialEq)]
pub struct PrintedNumber {
    /// Heading of its column and the text of the first cell of its row.
    pub place: String,
    /// Value in SI; in dB, degrees or percent if the quantity is stated in these everywhere.
    pub si: f64,
    number: CellNumber,
}

impl PrintedNumber {
    /// The number as it is printed.
    pub fn text(&self) -> String {
        self.number.text()
    }

    /// True if another value in SI is printed with the same digits.
    pub fn prints(&self, si: f64) -> bool {
        CellNumber { si, ..self.number }.text() == self.text()
    }
}

/// A part of a cell of a table, with its place.
struct PlacedCell<'d> {
    place: String,
    part: &'d Cell,
}

impl Document {
    /// The numbers in the cells of all tables, in the order in which they are printed.
    pub fn table_numbers(&self) -> Vec<PrintedNumber> {
        let number = |PlacedCell { place, part }: PlacedCell<'_>| match part {
            Cell::Number(number) => Some(PrintedNumber { place, si: number.si, number: *number }),
            Cell::Count(count) => {
                let unit = NumberUnit::Heading(DisplayUnit::ONE);
                let number = CellNumber::new(*count as f64, Digits::Decimal(0), unit);
                Some(PrintedNumber { place, si: number.si, number })
            }
            _ => None,
        };
        self.placed_cells().into_iter().filter_map(number).collect()
    }

    /// The texts in the cells of all tables, each with the place of its cell; they should contain
    /// no number of the answer.
    pub fn table_texts(&self) -> Vec<(String, String)> {
        let text = |PlacedCell { place, part }: PlacedCell<'_>| match part {
            Cell::Text(text) => Some((place, text.clone())),
            _ => None,
        };
        self.placed_cells().into_iter().filter_map(text).collect()
    }

    fn placed_cells(&self) -> Vec<PlacedCell<'_>> {
        self.blocks.iter().flat_map(Block::placed_cells).collect()
    }
}

impl Block {
    fn placed_cells(&self) -> Vec<PlacedCell<'_>> {
        match self {
            Block::Table(table) | Block::Folded(_, table) | Block::Requests(table) => table.placed_cells(),
            Block::SideBySide(document) => document.placed_cells(),
            _ => vec![],
        }
    }
}

impl Table {
    fn placed_cells(&self) -> Vec<PlacedCell<'_>> {
        let of_group = |name: &Cell| format!("group {}", name.text());
        let names = self.groups.iter().flat_map(move |group| {
            let place = of_group(&group.name);
            group.name.parts().into_iter().map(move |part| PlacedCell { place: place.clone(), part })
        });
        let cells = self.rows().flat_map(|row| {
            let first = row.first().map_or(String::new(), Cell::text);
            row.iter().zip(&self.headings).flat_map(move |(cell, heading)| {
                let place = format!("{heading} of {first}");
                cell.parts().into_iter().map(move |part| PlacedCell { place: place.clone(), part })
            })
        });
        names.chain(cells).collect()
    }
}

/// `4.31 dB`, with its sign; zero, for a limit that is just reached, without sign.
pub(crate) fn margin_words(margin_db: f64) -> String {
    match margin_db {
        _ if margin_db == f64::INFINITY => "unlimited".to_string(),
        _ if margin_db.abs() < 5e-4 => "0.000 dB".to_string(),
        _ if margin_db.abs() < 1.0 => format!("{margin_db:+.3} dB"),
        _ => format!("{margin_db:+.2} dB"),
    }
}

/// A frequency with four digits, without trailing zeros: `0.01`, `1304`.
pub(crate) fn frequency_number(frequency_rad_per_s: f64) -> String {
    if frequency_rad_per_s == f64::INFINITY {
        "inf".to_string()
    } else {
        display(frequency_rad_per_s, &RATIO, 4)
    }
}
