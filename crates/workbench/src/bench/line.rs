//! The tests of a line: text, JSON and tables.

use phea_dynamics::order::ends;
use phea_engineering::line_test::{LineRun, LineSeries};

use super::table::{BenchColumn, BenchFileAnswer, BenchTable};
use crate::answer::{Answer, OutputFile};
use crate::quantity::DisplayUnit;

/// The record of a test.
pub(super) fn recorded(run: &LineRun) -> BenchTable {
    let (names, unit) = match run.series {
        LineSeries::PressureRise => {
            (["volume_ml", "volume displaced into the line", "m3"], DisplayUnit::MILLILITRE)
        }
        LineSeries::FrequencyResponse => {
            (["flow_l_per_min", "flow into the line", "m3/s"], DisplayUnit::LITRE_PER_MINUTE)
        }
    };
    let input = BenchColumn::of(names, unit, run.inputs.clone());
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
    #[answer(interval)]
    pressure_pa: [f64; 2],
}

/// Oil that enters a blocked line.
#[derive(Answer)]
enum LineInputAnswer {
    PressureRise {
        /// Smallest and largest volume displaced into the line, only of a slow pressure rise.
        #[answer(interval)]
        volume_m3: [f64; 2],
    },
    FrequencyResponse {
        /// Smallest and largest flow into the line, only of a frequency response.
        #[answer(interval)]
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
