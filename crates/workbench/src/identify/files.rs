//! Contents of the files, and findings in them.

use std::borrow::Cow;

use phea_hydraulics::servovalve::PortCircuit;
use serde::Serialize;

use super::misfit::misfit_in_words;
use super::{ColumnContents, FileContents, Identification};
use crate::answer::Number;
use crate::document::{Cell, Document, Table};
use crate::project::{Diagnostic, TestSignal};
use crate::quantity::DisplayUnit;

/// The files as they were read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Read {
    /// Contents of each file.
    pub contents: Vec<FileContents>,
    /// Findings that did not lead to rejection.
    pub warnings: Vec<Diagnostic>,
}

#[derive(Serialize)]
pub(super) struct TestBody<'a> {
    file: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    test: Option<&'static str>,
    ports: &'static str,
    rows: usize,
    rows_left_out: usize,
    memory_at_start_v: f64,
    columns: Vec<ColumnBody<'a>>,
    unused_columns: &'a [String],
}

#[derive(Serialize)]
struct ColumnBody<'a> {
    heading: &'a str,
    signal: &'static str,
    read_in: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    reversed: Option<bool>,
    unit: &'static str,
    range: [Number; 2],
    gaps: usize,
}

#[derive(Serialize)]
pub(super) struct WarningBody<'a> {
    message: Cow<'a, str>,
    file: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    line: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    column: Option<usize>,
}

impl Read {
    pub(super) fn tests<'a>(&'a self, found: &'a Identification) -> Vec<TestBody<'a>> {
        let both = self.contents.iter().zip(&found.recordings);
        both.map(|(contents, recording)| TestBody {
            file: &contents.file,
            test: contents.test.map(|test| test.name()),
            ports: match recording.circuit {
                PortCircuit::Blocked => "blocked",
                PortCircuit::Connected => "connected",
            },
            rows: contents.rows,
            rows_left_out: contents.rows_left_out,
            memory_at_start_v: recording.memory_at_start(),
            columns: contents.columns.iter().map(column).collect(),
            unused_columns: &contents.unused,
        })
        .collect()
    }

    /// Findings in the files, and misfits of the model.
    pub(super) fn warnings<'a>(&'a self, found: &'a Identification) -> Vec<WarningBody<'a>> {
        let place = |number: usize| Some(number).filter(|number| *number > 0);
        let all = self.warnings.iter().map(|warning| WarningBody {
            message: Cow::from(&warning.message),
            file: &warning.file,
            line: place(warning.line),
            column: place(warning.column),
        });
        let misfits = found.misfits().into_iter().map(|misfit| WarningBody {
            message: Cow::from(misfit_in_words(found, &misfit)),
            file: found.recordings.get(misfit.recording).map_or("", |one| one.file.as_str()),
            line: None,
            column: None,
        });
        all.chain(misfits).collect()
    }

    /// A row for each column, and a sentence for columns that are not used and findings that were
    /// handled.
    pub(crate) fn write(&self, out: &mut Document) {
        let mut table = Table::grouped_by("file", ["column", "holds", "from", "to", "unit", "gaps"]);
        for file in &self.contents {
            table.group(file.file.clone());
            file.columns.iter().for_each(|column| table.row(row(column)));
        }
        out.section("What the files hold", table);
        let unused = self.contents.iter().filter(|file| !file.unused.is_empty()).map(|file| {
            let names: Vec<String> = file.unused.iter().map(|name| format!("`{name}`")).collect();
            format!("Not used of {}: {}.", file.file, names.join(", "))
        });
        let warnings = self.warnings.iter().map(|warning| match warning.line {
            0 => format!("{}: {}.", warning.file, warning.message),
            line => format!("{}:{line}: {}.", warning.file, warning.message),
        });
        out.sentences(unused.chain(warnings));
    }
}

fn column(column: &ColumnContents) -> ColumnBody<'_> {
    ColumnBody {
        heading: &column.heading,
        signal: column.signal.name(),
        read_in: &column.unit,
        reversed: column.is_reversed.then_some(true),
        unit: column.signal.dimension().si,
        range: column.range.map(Number),
        gaps: column.gaps,
    }
}

fn row(column: &ColumnContents) -> [Cell; 6] {
    let unit = match column.signal {
        TestSignal::Time => DisplayUnit::SECOND,
        TestSignal::Command => DisplayUnit::VOLT,
        TestSignal::LeakFlow | TestSignal::Flow => DisplayUnit::LITRE_PER_MINUTE,
        TestSignal::OilTemperature => DisplayUnit::DEGREE_CELSIUS,
        _ => DisplayUnit::BAR,
    };
    let signal = column.signal.name().replace('_', " ");
    let holds = if column.is_reversed { format!("{signal}, reversed") } else { signal };
    let [least, greatest] = column.range.map(|value| Cell::number(unit.of(value), 4));
    [
        Cell::Code(column.heading.clone()),
        Cell::from(holds),
        least,
        greatest,
        Cell::from(unit.symbol),
        Cell::count(column.gaps),
    ]
}
