//! The content of a cell of a table, with its type.

use std::borrow::Cow;

use phea_engineering::trial::Agreement;
use phea_qft::verification::Verdict;
use serde::{Deserialize, Serialize};

use super::number::{CellNumber, Digits, NumberUnit};
use crate::quantity::{Dimension, DisplayUnit};

/// A verdict as a form and a colour next to its word, so that no reader depends on a single one of
/// them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum StatusMark {
    /// A circle with a tick.
    Good,
    /// A triangle with an exclamation mark.
    Note,
    /// A square with a cross.
    Bad,
}

impl From<bool> for StatusMark {
    fn from(good: bool) -> StatusMark {
        if good { StatusMark::Good } else { StatusMark::Bad }
    }
}

impl From<Verdict> for StatusMark {
    fn from(verdict: Verdict) -> StatusMark {
        match verdict {
            Verdict::Met => StatusMark::Good,
            Verdict::NotProven => StatusMark::Note,
            Verdict::Violated => StatusMark::Bad,
        }
    }
}

impl From<Agreement> for StatusMark {
    fn from(agreement: Agreement) -> StatusMark {
        match agreement {
            Agreement::Agrees => StatusMark::Good,
            Agreement::AgreesButForSettling | Agreement::Differs => StatusMark::Note,
            Agreement::Contradicts => StatusMark::Bad,
        }
    }
}

/// A cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) enum Cell {
    /// Words, a sentence.
    Text(String),
    /// A path or a name of a file or of a program.
    Code(String),
    /// The name of a number for programs, such as `line.a.wave_speed`; the page shows its words
    /// with its symbol.
    Name { name: String, words: String, symbol: String },
    /// An equation or one of its symbols.
    Equation(String),
    /// A unit.
    Unit(Cow<'static, str>),
    /// A number.
    Number(CellNumber),
    /// A count.
    Count(usize),
    /// A good or bad result, with its mark.
    Status(StatusMark, Box<Cell>),
    /// A cell in bold letters.
    Strong(Box<Cell>),
    /// Cells that follow each other directly, in one.
    Joined(Vec<Cell>),
    /// A missing value.
    #[default]
    Missing,
}

impl Cell {
    /// Nothing at all.
    pub(crate) fn empty() -> Cell {
        Cell::Text(String::new())
    }

    /// A unit.
    pub(crate) fn unit(symbol: impl Into<Cow<'static, str>>) -> Cell {
        Cell::Unit(symbol.into())
    }

    /// A number in SI with this number of significant digits, the heading having its unit.
    pub(crate) fn number(value: f64, digits: usize) -> Cell {
        Cell::number_in(value, digits, DisplayUnit::ONE)
    }

    /// A number, converted from SI to a unit that the heading has.
    pub(crate) fn number_in(value: f64, digits: usize, unit: DisplayUnit) -> Cell {
        Cell::Number(CellNumber::new(value, Digits::Significant(digits), NumberUnit::Heading(unit)))
    }

    /// A number with its unit, converted from SI.
    pub(crate) fn quantity(value: f64, digits: usize, unit: DisplayUnit) -> Cell {
        Cell::Number(CellNumber::new(value, Digits::Significant(digits), NumberUnit::Symbol(unit)))
    }

    /// A number with its unit, converted from SI, without trailing zeros.
    pub(crate) fn short(value: f64, digits: usize, unit: DisplayUnit) -> Cell {
        Cell::Number(CellNumber::new(value, Digits::Shortest(digits), NumberUnit::Symbol(unit)))
    }

    /// A number in the customary unit for its size, without trailing zeros.
    pub(crate) fn customary(value: f64, digits: usize, dimension: &'static Dimension) -> Cell {
        Cell::Number(CellNumber::new(value, Digits::Shortest(digits), NumberUnit::Customary(dimension)))
    }

    /// A number whose sign the words next to it give.
    pub(crate) fn magnitude(value: f64, digits: usize, unit: DisplayUnit) -> Cell {
        Cell::Number(CellNumber::new(value, Digits::Magnitude(digits), NumberUnit::Symbol(unit)))
    }

    /// A number with its unit and this many decimal places, with its sign if it is positive too.
    pub(crate) fn change(value: f64, places: usize, unit: DisplayUnit) -> Cell {
        Cell::Number(CellNumber::new(value, Digits::Signed(places), NumberUnit::Symbol(unit)))
    }

    /// The number, as zero if its magnitude in SI is below this.
    pub(crate) fn zero_below(self, least: f64) -> Cell {
        match self {
            Cell::Number(number) => Cell::Number(CellNumber { zero_below: least, ..number }),
            other => other,
        }
    }

    /// A frequency in rad/s, the heading having the unit.
    pub(crate) fn frequency(value: f64) -> Cell {
        Cell::Number(CellNumber::new(value, Digits::Frequency, NumberUnit::Heading(DisplayUnit::ONE)))
    }

    /// A margin in dB.
    pub(crate) fn margin(value: f64) -> Cell {
        Cell::Number(CellNumber::new(value, Digits::Margin, NumberUnit::Heading(DisplayUnit::DECIBEL)))
    }

    /// A number with this many decimal places, converted from SI to a unit that the heading has;
    /// missing if it is not finite.
    pub(crate) fn decimal(value: f64, places: usize, unit: DisplayUnit) -> Cell {
        match value.is_finite() {
            true => Cell::Number(CellNumber::new(value, Digits::Decimal(places), NumberUnit::Heading(unit))),
            false => Cell::Missing,
        }
    }

    /// A count.
    pub(crate) fn count(value: usize) -> Cell {
        Cell::Count(value)
    }

    /// Cells in one, with a separator between each two.
    pub(crate) fn listed(cells: impl IntoIterator<Item = Cell>, separator: &str) -> Cell {
        let separated = cells.into_iter().enumerate().flat_map(|(index, cell)| {
            let before = (index > 0).then(|| Cell::from(separator));
            before.into_iter().chain([cell])
        });
        Cell::Joined(separated.collect())
    }

    /// The cell between two texts.
    pub(crate) fn between(self, before: &str, after: &str) -> Cell {
        Cell::from(before).then(self).then(after)
    }

    /// The cell with a mark.
    pub(crate) fn marked(self, mark: impl Into<StatusMark>) -> Cell {
        Cell::Status(mark.into(), Box::new(self))
    }

    /// The cell in bold letters.
    pub(crate) fn strong(self) -> Cell {
        Cell::Strong(Box::new(self))
    }

    /// The cell, followed directly by another one.
    pub(crate) fn then(self, next: impl Into<Cell>) -> Cell {
        let mut cells = match self {
            Cell::Joined(cells) => cells,
            first => vec![first],
        };
        cells.push(next.into());
        Cell::Joined(cells)
    }

    /// True if the cell is a number.
    pub(super) fn is_numeric(&self) -> bool {
        match self {
            Cell::Number(_) | Cell::Count(_) => true,
            Cell::Status(_, cell) | Cell::Strong(cell) => cell.is_numeric(),
            _ => false,
        }
    }

    /// The parts of which none has parts.
    pub(super) fn parts(&self) -> Vec<&Cell> {
        match self {
            Cell::Status(_, cell) | Cell::Strong(cell) => cell.parts(),
            Cell::Joined(cells) => cells.iter().flat_map(Cell::parts).collect(),
            cell => vec![cell],
        }
    }

    /// The cell as text, in which symbols and numbers are not typeset.
    pub(crate) fn text(&self) -> String {
        match self {
            Cell::Text(text) | Cell::Code(text) | Cell::Name { name: text, .. } => text.clone(),
            Cell::Status(_, cell) | Cell::Strong(cell) => cell.text(),
            Cell::Joined(cells) => cells.iter().map(Cell::text).collect(),
            Cell::Unit(unit) => unit.to_string(),
            // braces are needed only for typesetting
            Cell::Equation(equation) => equation.replace(['{', '}'], ""),
            Cell::Number(number) => number.text(),
            Cell::Count(count) => count.to_string(),
            Cell::Missing => "-".to_string(),
        }
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Cell {
        Cell::Text(text)
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Cell {
        Cell::Text(text.to_string())
    }
}

impl<T: Into<Cell>> From<Option<T>> for Cell {
    fn from(cell: Option<T>) -> Cell {
        cell.map_or(Cell::Missing, Into::into)
    }
}
