//! The tests of a line: text, JSON and tables.

use super::table::{BenchColumn, BenchTable};
use crate::answer::{Object, OutputFile};
use crate::line_test::{LineRun, LineSeries};
use crate::quantity::DisplayUnit;

/// The record of a test.
pub(super) fn recorded(run: &LineRun) -> BenchTable {
    let litres = DisplayUnit::LITRE_PER_MINUTE;
    let (name, quantity, unit, factor, si) = match run.series {
        LineSeries::PressureRise => ("volume_ml", "volume displaced into the line", "mL", 1e6, "m3"),
        LineSeries::FrequencyResponse => {
            ("flow_l_per_min", "flow into the line", litres.symbol, litres.of(1.0), "m3/s")
        }
    };
    let shown = run.inputs.iter().map(|input| factor * input).collect();
    let input = BenchColumn { name, quantity, unit, shown, si, values: run.inputs.clone() };
    let names = ["pressure_bar", "pressure at the open end", "Pa"];
    let pressure = BenchColumn::of(names, DisplayUnit::BAR, run.pressures.clone());
    BenchTable {
        name: run.series.name(),
        title: title(run.series),
        times: run.times.clone(),
        columns: vec![input, pressure],
    }
}

fn title(series: LineSeries) -> &'static str {
    match series {
        LineSeries::PressureRise => "Slow pressure rise of the blocked line",
        LineSeries::FrequencyResponse => "Frequency response of the blocked line",
    }
}

/// A test in JSON.
pub(super) fn line_test(run: &LineRun) -> Object {
    let table = recorded(run);
    let input = match run.series {
        LineSeries::PressureRise => "volume_m3",
        LineSeries::FrequencyResponse => "flow_m3_per_s",
    };
    let columns = [input, "pressure_pa"].into_iter().zip(&table.columns);
    columns.fold(table.json(), |out, (key, column)| out.with(key, column.range()))
}

/// The tables, a file for each test.
pub(crate) fn line_files(runs: &[LineRun]) -> Vec<OutputFile> {
    runs.iter().map(|run| recorded(run).file()).collect()
}
