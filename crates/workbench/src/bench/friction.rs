//! The runs of a cylinder for its friction: tables, JSON and text.

use std::io;

use serde::Serialize;

use super::{FrictionRow, FrictionRun, FrictionSeries};
use crate::answer::{NumberTable, OutputFile, TableFormat};
use crate::document::{Cell, Document, Table};
use crate::quantity::{DisplayUnit, TIME, display};

#[derive(Serialize)]
pub(super) struct FrictionRunAnswer {
    name: &'static str,
    file: String,
    rows: usize,
    duration_s: f64,
    /// Smallest and largest value of each signal, as recorded.
    signals: Vec<FrictionSignalAnswer>,
}

#[derive(Serialize)]
struct FrictionSignalAnswer {
    name: &'static str,
    unit: &'static str,
    range: [f64; 2],
}

/// A column of a run's table: its name, what it is for people, unit of the table and of SI, value.
struct RunSignal {
    column: &'static str,
    quantity: &'static str,
    unit: DisplayUnit,
    si: &'static str,
    of: fn(&FrictionRow) -> f64,
}

const SIGNALS: [RunSignal; 3] = [
    RunSignal {
        column: "position_mm",
        quantity: "position",
        unit: DisplayUnit::MILLIMETRE,
        si: "m",
        of: |row| row.position,
    },
    RunSignal {
        column: "pressure_a_bar",
        quantity: "pressure at A",
        unit: DisplayUnit::BAR,
        si: "Pa",
        of: |row| row.pressure_a,
    },
    RunSignal {
        column: "pressure_b_bar",
        quantity: "pressure at B",
        unit: DisplayUnit::BAR,
        si: "Pa",
        of: |row| row.pressure_b,
    },
];

fn range(run: &FrictionRun, signal: &RunSignal) -> [f64; 2] {
    let values = || run.rows.iter().map(|row| (signal.of)(row));
    [values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max)]
}

fn file_name(run: &FrictionRun) -> String {
    format!("{}.csv", run.series.name())
}

pub(super) fn answers(runs: &[FrictionRun]) -> Vec<FrictionRunAnswer> {
    let signal = |run: &FrictionRun, signal: &RunSignal| FrictionSignalAnswer {
        name: signal.quantity,
        unit: signal.si,
        range: range(run, signal),
    };
    let answer = |run: &FrictionRun| FrictionRunAnswer {
        name: run.series.name(),
        file: file_name(run),
        rows: run.rows.len(),
        duration_s: run.rows.last().map_or(0.0, |row| row.time),
        signals: SIGNALS.iter().map(|one| signal(run, one)).collect(),
    };
    runs.iter().map(answer).collect()
}

/// A section for each run.
pub(super) fn tell(runs: &[FrictionRun], out: &mut Document) {
    for run in runs {
        let rows = SIGNALS.iter().map(|signal| {
            let [least, most] = range(run, signal).map(|value| Cell::number(signal.unit.of(value), 6));
            [Cell::from(signal.quantity), least, most, Cell::from(signal.unit.symbol)]
        });
        out.section(title(run.series), Table::new(["recorded", "least", "most", "unit"]).with(rows));
        let duration = run.rows.last().map_or(0.0, |row| row.time);
        out.sentences([format!("{} rows in {}.", run.rows.len(), display(duration, &TIME, 4))]);
    }
}

fn title(series: FrictionSeries) -> &'static str {
    match series {
        FrictionSeries::Sliding => "Cylinder at constant velocities, both ways",
        FrictionSeries::Breakaway => "Cylinder pressed from A to B until it breaks away",
        FrictionSeries::BreakawayBack => "Cylinder pressed from B to A until it breaks away",
        FrictionSeries::Shaken => "Cylinder shaken before it breaks away",
    }
}

/// The tables, a file for each run.
pub(super) fn files(runs: &[FrictionRun]) -> Vec<OutputFile> {
    // nothing that is written to memory can fail
    let file = |run: &FrictionRun| OutputFile { name: file_name(run), bytes: table(run).unwrap_or_default() };
    runs.iter().map(file).collect()
}

fn table(run: &FrictionRun) -> io::Result<Vec<u8>> {
    let columns: Vec<&str> =
        std::iter::once("time_s").chain(SIGNALS.iter().map(|signal| signal.column)).collect();
    let mut table = NumberTable::new(Vec::new(), TableFormat::Csv, &columns)?;
    for row in &run.rows {
        let shown = SIGNALS.iter().map(|signal| signal.unit.of((signal.of)(row)));
        table.row(&std::iter::once(row.time).chain(shown).collect::<Vec<f64>>())?;
    }
    table.finish()
}
