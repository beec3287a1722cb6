//! Contents of the files, and findings in them.

use phea_engineering::identify::{ColumnContents, FileContents, Identification};
use phea_hydraulics::servovalve::PortCircuit;

use super::misfit::misfit_in_words;
use crate::answer::{Answer, FileWarningAnswer, words};
use crate::document::{Cell, Document, Table};
use crate::project::{Diagnostic, StaticTest, TestSignal};
use crate::quantity::DisplayUnit;

/// The files as they were read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Read {
    /// Contents of each file.
    pub contents: Vec<FileContents>,
    /// Findings that did not lead to rejection.
    pub warnings: Vec<Diagnostic>,
}

/// Recorded test as it was read.
#[derive(Answer)]
pub(super) struct ValveTestAnswer {
    /// Path of the file.
    file: String,
    /// Test as the project declares it, if so.
    #[answer(optional)]
    test: Option<StaticTest>,
    /// Piping of the ports.
    ports: PortCircuit,
    /// Number of rows that are used.
    rows: usize,
    /// Number of rows that are omitted, each with a warning.
    rows_left_out: usize,
    /// Lag of the spool at the first row from earlier cycles; zero if the rows do not show one.
    memory_at_start_v: f64,
    /// Columns that are used.
    columns: Vec<ColumnAnswer>,
    /// Headings of columns that are not used.
    unused_columns: Vec<String>,
}

/// Column of a recorded test that is used.
#[derive(Answer)]
struct ColumnAnswer {
    /// Heading of the column.
    heading: String,
    /// Signal of the column.
    signal: TestSignal,
    /// Unit in which the column was read.
    read_in: String,
    /// True if the sign of the column was reversed; only then present.
    #[answer(optional)]
    reversed: Option<bool>,
    /// Unit of `range`.
    unit: &'static str,
    /// Least and greatest value of the rows that are used; inf and -inf if none has a value.
    #[answer(interval)]
    range: [f64; 2],
    /// Number of rows without a value.
    gaps: usize,
}

words! {
    /// Piping of the ports of a valve: blocked, or connected through a meter.
    PortCircuit { Blocked => "blocked", Connected => "connected" }
}

words! {
    /// Signal of a recorded static test.
    TestSignal by TestSignal::name [
        Time, Command, SupplyPressure, TankPressure, PressureA, PressureB, LeakFlow, Flow, OilTemperature,
    ]
}

impl Read {
    pub(super) fn tests(&self, found: &Identification) -> Vec<ValveTestAnswer> {
        let both = self.contents.iter().zip(&found.recordings);
        both.map(|(contents, recording)| ValveTestAnswer {
            file: contents.file.clone(),
            test: contents.test,
            ports: recording.circuit,
            rows: contents.rows,
            rows_left_out: contents.rows_left_out,
            memory_at_start_v: recording.memory_at_start(),
            columns: contents.columns.iter().map(column).collect(),
            unused_columns: contents.unused.clone(),
        })
        .collect()
    }

    /// Findings in the files, and misfits of the model.
    pub(super) fn warnings(&self, found: &Identification) -> Vec<FileWarningAnswer> {
        let place = |number: usize| Some(number).filter(|number| *number > 0);
        let all = self.warnings.iter().map(|warning| FileWarningAnswer {
            message: warning.message.clone(),
            file: warning.file.clone(),
            line: place(warning.line),
            column: place(warning.column),
        });
        let misfits = found.misfits().into_iter().map(|misfit| {
            let file = found.recordings.get(misfit.recording).map_or("", |one| one.file.as_str());
            FileWarningAnswer::of_file(misfit_in_words(found, &misfit), file)
        });
        all.chain(misfits).collect()
    }

    /// A row for each column, and a sentence for columns that are not used and findings that were
    /// handled.
    pub(crate) fn write(&self, out: &mut Document) {
        let mut table = Table::grouped_by("file", ["column", "holds", "from", "to", "unit", "gaps"]);
        for file in &self.contents {
            table.group(Cell::Code(file.file.clone()));
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

fn column(column: &ColumnContents) -> ColumnAnswer {
    ColumnAnswer {
        heading: column.heading.clone(),
        signal: column.signal,
        read_in: column.unit.clone(),
        reversed: column.is_reversed.then_some(true),
        unit: column.signal.dimension().si,
        range: column.range,
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
    let [least, greatest] = column.range.map(|value| Cell::number_in(value, 4, unit));
    [
        Cell::Code(column.heading.clone()),
        Cell::from(holds),
        least,
        greatest,
        Cell::unit(unit.symbol),
        Cell::count(column.gaps),
    ]
}
