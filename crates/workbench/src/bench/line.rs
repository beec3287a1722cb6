//! The tests of a line: text, JSON and tables.

use std::io;

use crate::answer::{NumberTable, Object, OutputFile, TableFormat};
use crate::document::{Cell, Document, Table};
use crate::line_test::{LineRun, LineSeries};
use crate::quantity::{DisplayUnit, TIME, display};

/// What enters the line in a test: in words, its column, its unit in the table and the factor to it.
fn input(series: LineSeries) -> (&'static str, &'static str, &'static str, f64) {
    match series {
        LineSeries::PressureRise => ("volume displaced into the line", "volume_ml", "mL", 1e6),
        LineSeries::FrequencyResponse => {
            let unit = DisplayUnit::LITRE_PER_MINUTE;
            ("flow into the line", "flow_l_per_min", unit.symbol, unit.of(1.0))
        }
    }
}

/// A table for each test.
pub fn line_text(runs: &[LineRun]) -> String {
    let mut out = Document::default();
    for run in runs {
        let (name, _, unit, factor) = input(run.series);
        let bar = DisplayUnit::BAR;
        let signals = [
            (name, &run.inputs, factor, unit),
            ("pressure at the open end", &run.pressures, bar.of(1.0), bar.symbol),
        ];
        let rows = signals.map(|(name, values, factor, unit)| {
            let [least, most] = ends(values).map(|value| Cell::number(factor * value, 4));
            [Cell::from(name), least, most, Cell::from(unit)]
        });
        out.section(title(run.series), Table::new(["recorded", "least", "most", "unit"]).with(rows));
        let duration = run.times.last().copied().unwrap_or(0.0);
        out.sentences([format!("{} rows in {}.", run.times.len(), display(duration, &TIME, 4))]);
    }
    if runs.is_empty() { String::new() } else { format!("\n{}", out.text()) }
}

fn title(series: LineSeries) -> &'static str {
    match series {
        LineSeries::PressureRise => "Slow pressure rise of the blocked line",
        LineSeries::FrequencyResponse => "Frequency response of the blocked line",
    }
}

fn ends(values: &[f64]) -> [f64; 2] {
    let all = || values.iter().copied();
    [all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max)]
}

/// A test in JSON.
pub(super) fn line_test(run: &LineRun) -> Object {
    Object::new()
        .with("name", run.series.name())
        .with("file", file_name(run))
        .with("rows", run.times.len())
        .with("duration_s", run.times.last().copied())
        .with(
            match run.series {
                LineSeries::PressureRise => "volume_m3",
                LineSeries::FrequencyResponse => "flow_m3_per_s",
            },
            ends(&run.inputs),
        )
        .with("pressure_pa", ends(&run.pressures))
}

fn file_name(run: &LineRun) -> String {
    format!("{}.csv", run.series.name())
}

/// The tables, a file for each test.
pub fn line_files(runs: &[LineRun]) -> Vec<OutputFile> {
    // nothing that is written to memory can fail
    runs.iter()
        .map(|run| OutputFile { name: file_name(run), bytes: table(run).unwrap_or_default() })
        .collect()
}

fn table(run: &LineRun) -> io::Result<Vec<u8>> {
    let (_, column, _, factor) = input(run.series);
    let columns = ["time_s", column, "pressure_bar"];
    let mut table = NumberTable::new(Vec::new(), TableFormat::Csv, &columns)?;
    for ((time, input), pressure) in run.times.iter().zip(&run.inputs).zip(&run.pressures) {
        table.row(&[*time, factor * input, DisplayUnit::BAR.of(*pressure)])?;
    }
    table.finish()
}
