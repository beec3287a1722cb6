//! The content of a cell of a table, with its type.

use crate::verdict_words::{frequency_number, margin_words, verdict_words};
use phea_engineering::trial::Agreement;
use phea_qft::verification::Verdict;

use std::borrow::Cow;

use crate::answer::significant;
use crate::quantity::DisplayUnit;

/// A verdict as a form and a colour next to its word, so that no reader depends on a single one of
/// them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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

/// Rule for the number of digits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Precision {
    /// This many significant digits.
    Significant(usize),
    /// Four significant digits without trailing zeros, as for a frequency.
    Frequency,
    /// A signed number, to a hundredth or a thousandth, as for a margin in dB.
    Margin,
    /// This number of decimal places; zero has no sign.
    Decimal(usize),
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
    /// A number with its unit; the unit is empty if the heading has it.
    Quantity { value: f64, precision: Precision, unit: &'static str },
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

    /// A number with this number of significant digits.
    pub(crate) fn number(value: f64, digits: usize) -> Cell {
        Cell::Quantity { value, precision: Precision::Significant(digits), unit: "" }
    }

    /// A number with its unit, converted from SI.
    pub(crate) fn quantity(value: f64, digits: usize, unit: DisplayUnit) -> Cell {
        let symbol = if unit.symbol == "1" { "" } else { unit.symbol };
        Cell::Quantity { value: unit.of(value), precision: Precision::Significant(digits), unit: symbol }
    }

    /// A frequency in rad/s, the heading having the unit.
    pub(crate) fn frequency(value: f64) -> Cell {
        Cell::Quantity { value, precision: Precision::Frequency, unit: "" }
    }

    /// A margin in dB.
    pub(crate) fn margin(value: f64) -> Cell {
        Cell::Quantity { value, precision: Precision::Margin, unit: "" }
    }

    /// A number with this many decimal places; missing if it is not finite.
    pub(crate) fn decimal(value: f64, places: usize) -> Cell {
        match value.is_finite() {
            true => Cell::Quantity { value, precision: Precision::Decimal(places), unit: "" },
            false => Cell::Missing,
        }
    }

    /// A count.
    pub(crate) fn count(value: usize) -> Cell {
        Cell::Text(value.to_string())
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

    /// The cell of a verdict.
    pub(crate) fn verdict(verdict: Verdict) -> Cell {
        Cell::from(verdict_words(verdict)).marked(verdict)
    }
    /// True if the cell is a number.
    pub(super) fn is_numeric(&self) -> bool {
        match self {
            Cell::Quantity { .. } => true,
            Cell::Status(_, cell) => cell.is_numeric(),
            Cell::Text(text) => text.parse::<f64>().is_ok(),
            _ => false,
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
            Cell::Quantity { value, precision, unit } => {
                let number = number(*value, *precision);
                if unit.is_empty() { number } else { format!("{number} {unit}") }
            }
            Cell::Missing => "-".to_string(),
        }
    }
}

/// The digits of a number.
fn number(value: f64, precision: Precision) -> String {
    match precision {
        Precision::Significant(digits) => significant(value, digits),
        Precision::Frequency => frequency_number(value),
        Precision::Margin => margin_words(value),
        Precision::Decimal(places) => {
            let text = format!("{value:.places$}");
            let is_zero = text.trim_start_matches('-').trim_matches(['0', '.']).is_empty();
            if is_zero { text.replace('-', "") } else { text }
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
