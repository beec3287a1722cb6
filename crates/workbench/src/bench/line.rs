//! The tests of a line: text, JSON and tables.

use phea_dynamics::order::ends;

use super::table::{BenchColumn, BenchFileAnswer, BenchTable};
use crate::answer::{Answer, OutputFile};
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
    let printed = run.inputs.iter().map(|input| factor * input).collect();
    let input = BenchColumn { name, quantity, unit, printed, si, values: run.inputs.clone() };
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

/// Test of a blocked line.
#[derive(Answer)]
pub(super) struct LineTestTableAnswer {
    #[answer(flatten)]
    file: BenchFileAnswer,
    #[answer(flatten)]
    input: LineInputAnswer,
    /// Smallest and largest pressure at the open end.
    pressure_pa: [f64; 2],
}

/// Oil that enters a blocked line.
#[derive(Answer)]
enum LineInputAnswer {
    PressureRise {
        /// Smallest and largest volume displaced into the line, only of a slow pressure rise.
        volume_m3: [f64; 2],
    },
    FrequencyResponse {
        /// Smallest and largest flow into the line, only of a frequency response.
        flow_m3_per_s: [f64; 2],
    },
}

/// A test for programs.
pub(super) fn line_test(run: &LineRun) -> LineTestTableAnswer {
    let range = |values: &[f64]| ends(values.iter().copied());
    let input = range(&run.inputs);
    LineTestTableAnswer {
        file: recorded(run).file_answer(),
        input: match run.series {
            LineSeries::PressureRise => LineInputAnswer::PressureRise { volume_m3: input },
            LineSeries::FrequencyResponse => LineInputAnswer::FrequencyResponse { flow_m3_per_s: input },
        },
        pressure_pa: range(&run.pressures),
    }
}

/// The tables, a file for each test.
pub(crate) fn line_files(runs: &[LineRun]) -> Vec<OutputFile> {
    runs.iter().map(|run| recorded(run).file()).collect()
}
