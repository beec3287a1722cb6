//! Signals of columns, and their units.

use super::error::{ColumnError, TableHint};
use super::heading::{bare, endings, unit_beside, unit_meant};
use super::{Heading, MeasuredTable};
use crate::project::{Findings, RawFinding};
use crate::quantity::{CURRENT, Dimension, RATIO, TIME, UnitScale};
use crate::spelling::nearest;

/// Quantity in a column, by the name in its heading.
#[derive(Clone, Copy, Debug)]
pub struct Measurand {
    /// Name in words with underscores; a heading may have spaces, hyphens and capitals.
    pub name: &'static str,
    /// Other names, such as symbols in formulae: recognised next to a fitting unit; a word of
    /// several letters also without a unit.
    pub symbols: &'static [&'static str],
    /// Dimension of the unit.
    pub dimension: &'static Dimension,
    /// True if the quantity may be a fraction, in percent, of a value that is not in the table.
    pub may_be_fraction: bool,
}

impl Measurand {
    /// A quantity recognised by its name.
    pub const fn of(name: &'static str, dimension: &'static Dimension) -> Measurand {
        Measurand { name, symbols: &[], dimension, may_be_fraction: false }
    }

    /// The quantity with additional names.
    pub const fn called(self, symbols: &'static [&'static str]) -> Measurand {
        Measurand { symbols, ..self }
    }
}

/// Times of the rows, by the names that loggers use.
pub static TIMES: Measurand = Measurand::of("time", &TIME).called(TIME_NAMES);
/// Names that loggers use for the time.
pub const TIME_NAMES: &[&str] = &["t", "X_Value", "timestamp", "datetime", "date_time", "date/time"];
/// Length of the shortest word that names a signal without its unit.
const WORD: usize = 3;

/// A required signal, by its name or by the heading and unit that a project states.
#[derive(Clone, Copy, Debug)]
pub struct Sought<'a> {
    /// Quantity of the signal.
    pub measurand: &'a Measurand,
    /// Heading of its column; absent: the name of the quantity.
    pub heading: Option<&'a str>,
    /// Unit of its column; absent: that of the heading.
    pub unit: Option<&'a str>,
    /// True if its numbers have the opposite sign of the signal.
    pub is_reversed: bool,
}

/// A column that was found.
#[derive(Clone, Debug)]
pub struct Column {
    /// Index, from 0.
    pub index: usize,
    /// Unit, as quantities spell it; empty for a pure number.
    pub unit: String,
    /// True if its numbers are fractions.
    pub is_fraction: bool,
    /// True if the signal is its numbers with the opposite sign.
    pub is_reversed: bool,
    pub(super) scale: UnitScale,
    /// True if the column may contain time stamps of a clock.
    pub(super) is_time: bool,
}

impl Column {
    /// Description of the expected values.
    pub fn expected(&self) -> String {
        if self.unit.is_empty() { "a number".to_string() } else { format!("a number in {}", self.unit) }
    }
}

/// Signs that enclose the unit after a heading that a project states.
const BRACKETS: [char; 5] = ['[', '(', '{', '<', '/'];

impl<'a> Sought<'a> {
    /// A signal with the name of its quantity as heading.
    pub fn by_name(measurand: &'a Measurand) -> Sought<'a> {
        Sought { measurand, heading: None, unit: None, is_reversed: false }
    }

    /// Unit that the heading states, if the heading is that of the signal.
    pub(super) fn unit_in<'h>(&self, heading: &'h str) -> Option<&'h str> {
        match self.heading {
            Some(stated) if stated == heading => {
                let enclosed = heading.rfind(BRACKETS).and_then(|at| heading.get(at..));
                enclosed.or_else(|| unit_beside(heading, self.measurand.name)).or(Some(""))
            }
            Some(stated) => {
                heading.strip_prefix(stated).filter(|rest| rest.trim_start().starts_with(BRACKETS))
            }
            None => unit_beside(heading, self.measurand.name).or_else(|| self.unit_by_symbol(heading)),
        }
    }

    fn unit_by_symbol<'h>(&self, heading: &'h str) -> Option<&'h str> {
        let known = |symbol: &&'static str| {
            let unit = unit_beside(heading, symbol)?;
            let is_word = symbol.len() >= WORD && unit.is_empty();
            (is_word || self.unit_of(unit).is_some()).then_some(unit)
        };
        self.measurand.symbols.iter().find_map(known)
    }

    /// `Some` if a heading names the signal: true if it contains nothing else but a unit of it.
    pub(super) fn is_named_in(&self, heading: &str) -> Option<bool> {
        let unit = bare(self.unit_in(heading)?);
        Some(unit.is_empty() || self.unit.is_some() || self.unit_of(unit).is_some())
    }

    /// Unit and scale of a written unit.
    fn unit_of(&self, written: &str) -> Option<(String, UnitScale)> {
        if self.measurand.may_be_fraction && ["%", "percent"].contains(&written) {
            return Some(("%".to_string(), UnitScale::new("%", &RATIO).ok()?));
        }
        let dimension = self.measurand.dimension;
        let unit = if written.is_empty() { String::new() } else { unit_meant(written, dimension)? };
        let scale = UnitScale::new(&unit, dimension).ok()?;
        Some((unit, scale))
    }

    /// Usual headings of the signal, for an error message.
    pub(super) fn usual_names(&self) -> Vec<String> {
        let name = self.measurand.name;
        if let Some(stated) = self.heading {
            return vec![stated.to_string()];
        }
        let pure = UnitScale::new("", self.measurand.dimension).is_ok().then(|| name.to_string());
        let fraction = self.measurand.may_be_fraction.then(|| format!("{name}_percent"));
        let united = endings(self.measurand.dimension).map(|unit| format!("{name}_{unit}"));
        united.chain(pure).chain(fraction).collect()
    }
}

impl MeasuredTable {
    /// The column of each signal, if it exists, and the columns of no signal. `None` if a signal
    /// has two columns, or a unit is missing.
    pub fn columns(
        &self,
        sought: &[Sought<'_>],
        findings: &mut Findings,
    ) -> Option<(Vec<Option<Column>>, Vec<usize>)> {
        let before = findings.error_count();
        let found: Vec<Option<Column>> = sought.iter().map(|sought| self.column(sought, findings)).collect();
        let taken = |index: usize| found.iter().flatten().filter(|column| column.index == index).count();
        for (index, heading) in self.headings.iter().enumerate().filter(|(index, _)| taken(*index) > 1) {
            let message =
                ColumnError::TakenForSeveral { heading: heading.text.clone(), signals: taken(index) };
            findings.push(RawFinding::error(heading.place, message.to_string()));
        }
        let has_name =
            |index: &usize| self.headings.get(*index).is_some_and(|heading| !heading.text.is_empty());
        let unused = (0..self.headings.len()).filter(|index| taken(*index) == 0).filter(has_name).collect();
        (findings.error_count() == before).then_some((found, unused))
    }

    fn column(&self, sought: &Sought<'_>, findings: &mut Findings) -> Option<Column> {
        let all = || self.headings.iter().enumerate();
        let is_exact = |heading: &Heading| match sought.heading {
            Some(stated) => stated == heading.text,
            None => unit_beside(&heading.text, sought.measurand.name).is_some(),
        };
        let any_exact = all().any(|(_, heading)| is_exact(heading));
        let mut matching = all().filter(|(_, heading)| !any_exact || is_exact(heading));
        let mut matching = matching
            .by_ref()
            .filter_map(|(index, heading)| Some((index, heading, bare(sought.unit_in(&heading.text)?))));
        let (index, heading, beside) = matching.next()?;
        if let Some((_, second, _)) = matching.next() {
            let message = match sought.heading {
                Some(stated) => ColumnError::SecondStated(stated.to_string()),
                None => ColumnError::SecondOfSignal {
                    heading: second.text.clone(),
                    signal: sought.measurand.name,
                },
            };
            findings.push(RawFinding::error(second.place, message.to_string()));
            return None;
        }
        let said = if beside.is_empty() { heading.unit.as_deref().map_or("", bare) } else { beside };
        let is_time = std::ptr::eq(sought.measurand.dimension, &TIME);
        if is_time && self.is_clock(index, findings) {
            let scale = UnitScale::new(TIME.si, &TIME).ok()?;
            let unit = TIME.si.to_string();
            return Some(Column { index, unit, is_fraction: false, is_reversed: false, scale, is_time });
        }
        let Some((unit, scale)) = sought.unit_of(sought.unit.unwrap_or(said)) else {
            findings.push(self.without_unit(sought, heading, sought.unit.unwrap_or(said)));
            return None;
        };
        if let Some((other, _)) = sought
            .unit_of(said)
            .filter(|(other, _)| sought.unit.is_some() && *other != unit && !other.is_empty())
        {
            let message =
                ColumnError::ReadInStatedUnit { heading: heading.text.clone(), stated: unit.clone(), other };
            findings.push(RawFinding::warning(heading.place, message.to_string()));
        }
        let is_fraction = sought.measurand.may_be_fraction && unit == "%";
        Some(Column { index, unit, is_fraction, is_reversed: sought.is_reversed, scale, is_time })
    }

    fn without_unit(&self, sought: &Sought<'_>, heading: &Heading, written: &str) -> RawFinding {
        let message = match written {
            "" => ColumnError::NoUnit(heading.text.clone()),
            written => ColumnError::NotAUnit {
                written: written.to_string(),
                dimension: sought.measurand.dimension.name,
            },
        };
        let names: Vec<String> = match sought.heading {
            Some(stated) => {
                endings(sought.measurand.dimension).map(|unit| format!("{stated} [{unit}]")).collect()
            }
            None => sought.usual_names(),
        };
        let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
        let found = RawFinding::error(heading.place, message.to_string())
            .expected(TableHint::OneOf(quoted.join(", ")).to_string());
        let is_absolute = ["bara", "psia"].contains(&written.to_lowercase().as_str());
        let near = nearest(written, endings(sought.measurand.dimension));
        let is_current = sought.measurand.may_be_fraction && unit_meant(written, &CURRENT).is_some();
        let hint = match near {
            _ if is_current => Some(TableHint::CurrentAsPercent(sought.measurand.name)),
            _ if is_absolute => Some(TableHint::AbsolutePressure),
            near => near.map(|near| match sought.heading {
                Some(_) => TableHint::Near(near.to_string()),
                None => TableHint::Near(format!("{}_{near}", sought.measurand.name)),
            }),
        };
        found.maybe_help(hint.map(|hint| hint.to_string()))
    }

    /// Error for a missing signal column, with the closest heading.
    pub fn missing(&self, sought: &Sought<'_>) -> RawFinding {
        let headings = || self.headings.iter().map(|heading| heading.text.as_str());
        let names = sought.usual_names();
        let near = names.iter().find_map(|name| nearest(name, headings()));
        let near = near.or_else(|| nearest(sought.measurand.name, headings()));
        let message = ColumnError::Missing(sought.heading.unwrap_or(sought.measurand.name).to_string());
        let found = RawFinding::error(self.header_place(), message.to_string());
        let found = match sought.heading {
            Some(_) => found,
            None => {
                let shown: Vec<String> = names.iter().take(4).map(|name| format!("`{name}`")).collect();
                found.expected(TableHint::OneSuchAs(shown.join(", ")).to_string())
            }
        };
        let hint = match near {
            Some(near) => TableHint::Near(near.to_string()),
            None => TableHint::Headings(headings().collect::<Vec<_>>().join(", ")),
        };
        found.help(hint.to_string())
    }

    /// Columns that name none of these signals.
    pub fn unnamed<'a>(&'a self, sought: &'a [Sought<'a>]) -> impl Iterator<Item = usize> + 'a {
        let is_unnamed = |heading: &Heading| {
            !heading.text.is_empty() && sought.iter().all(|one| one.is_named_in(&heading.text).is_none())
        };
        let all = self.headings.iter().enumerate();
        all.filter(move |(_, heading)| is_unnamed(heading)).map(|(index, _)| index)
    }

    /// Error for a column of no signal, with the closest name.
    pub fn unknown(&self, index: usize, sought: &[Sought<'_>]) -> RawFinding {
        let place = self.headings.get(index).map(|heading| heading.place).unwrap_or_default();
        let text = self.headings.get(index).map_or("", |heading| &heading.text);
        let names: Vec<String> = sought.iter().flat_map(Sought::usual_names).collect();
        let found = RawFinding::error(place, ColumnError::Unknown(text.to_string()).to_string());
        let hint = match nearest(text, names.iter().map(String::as_str)) {
            Some(near) => TableHint::Near(near.to_string()),
            None => TableHint::KnownNames(names.join(", ")),
        };
        found.help(hint.to_string())
    }
}
