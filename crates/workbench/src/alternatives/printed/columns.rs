//! The numbers of an alternative, as they are printed.

use phea_engineering::alternatives::{AlternativeColumn, ColumnKey, ColumnPart, NoNumber};
use serde::{Deserialize, Serialize};

use super::super::words::{NOT_STATED, is_unstated, no_number_words};
use super::encoding;
use crate::quantity::DisplayUnit;
use crate::specification::subject_words;

/// A number of an alternative.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct PrintedColumn {
    /// Part to which the number belongs.
    pub(crate) part: PrintedPart,
    /// Key of the number.
    #[serde(with = "encoding::column_key")]
    pub(crate) key: ColumnKey,
    /// Unit for display.
    #[serde(with = "crate::unit_encoding")]
    pub(crate) unit: DisplayUnit,
    /// Significant digits for display; 0 for a whole number.
    pub(crate) digits: usize,
    /// Value, SI.
    pub(crate) value: Result<f64, Unprintable>,
}

/// Part of an alternative to which a number belongs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) enum PrintedPart {
    /// The designed loop.
    Loop,
    /// The rig.
    Rig,
    /// The impedance at the load at a frequency, rad/s.
    Impedance(f64),
    /// A specification, by its number from 0 and its subject.
    Specification(usize, String),
    /// A scenario.
    Scenario(String),
}

/// A number that is not printed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) enum Unprintable {
    /// The project should state something, in words.
    NotStated(String),
    /// The number does not exist.
    Absent,
}

impl PrintedColumn {
    pub(super) fn of((part, column): (ColumnPart, AlternativeColumn)) -> PrintedColumn {
        let AlternativeColumn { key, unit, digits, value } = column;
        let part = PrintedPart::of(part);
        PrintedColumn { part, key, unit, digits, value: value.map_err(|reason| Unprintable::of(&reason)) }
    }

    /// True if the table of all numbers has a row for the number.
    pub(crate) fn is_shown(&self) -> bool {
        !matches!(self.value, Err(Unprintable::Absent))
    }
}

impl PrintedPart {
    fn of(part: ColumnPart) -> PrintedPart {
        match part {
            ColumnPart::Loop => PrintedPart::Loop,
            ColumnPart::Rig => PrintedPart::Rig,
            ColumnPart::Impedance(frequency) => PrintedPart::Impedance(frequency),
            ColumnPart::Specification(index, name) => {
                PrintedPart::Specification(index, subject_words(name).to_string())
            }
            ColumnPart::Scenario(name) => PrintedPart::Scenario(name),
        }
    }
}

impl Unprintable {
    fn of(reason: &NoNumber) -> Unprintable {
        match reason {
            // the table of its part lists what is missing
            NoNumber::Parts(_) if is_unstated(reason) => Unprintable::NotStated(no_number_words(reason)),
            reason if is_unstated(reason) => Unprintable::NotStated(NOT_STATED.to_string()),
            _ => Unprintable::Absent,
        }
    }
}

/// The parts of all alternatives, in the order in which they first come.
pub(crate) fn parts(all: &[&[PrintedColumn]]) -> Vec<PrintedPart> {
    let mut parts = Vec::new();
    for PrintedColumn { part, .. } in all.iter().copied().flatten() {
        if !parts.contains(part) {
            parts.push(part.clone());
        }
    }
    parts
}

/// A number of an alternative.
pub(crate) fn at<'c>(
    columns: &'c [PrintedColumn],
    part: &PrintedPart,
    key: ColumnKey,
) -> Option<&'c PrintedColumn> {
    columns.iter().find(|column| column.part == *part && column.key == key)
}
