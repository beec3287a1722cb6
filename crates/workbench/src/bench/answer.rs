use std::io;

use serde::Serialize;

use super::friction::{self, FrictionRunAnswer};
use super::line::line_test;
use super::{BenchRow, BenchRun, FrictionRun, ReversalReading};
use crate::answer::{self, Json, NumberTable, OutputFile, TableFormat};
use crate::line_test::LineRun;
use crate::project::Loaded;
use crate::quantity::DisplayUnit;

#[derive(Serialize)]
struct BenchAnswer {
    /// What the tests leave out of the project.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    remarks: Vec<&'static str>,
    tests: Vec<BenchTestAnswer>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    line_tests: Vec<Json>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    friction_runs: Vec<FrictionRunAnswer>,
}

#[derive(Serialize)]
struct BenchTestAnswer {
    name: &'static str,
    file: String,
    rows: usize,
    duration_s: f64,
    /// Smallest and largest value of each signal, as recorded.
    signals: Vec<BenchSignalAnswer>,
    lowest_supply_pressure_pa: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    reversals: Option<ReversalsAnswer>,
}

#[derive(Serialize)]
struct ReversalsAnswer {
    hysteresis_v: BenchReadingAnswer,
    threshold_v: BenchReadingAnswer,
    hysteresis_share_of_nominal: f64,
    threshold_share_of_nominal: f64,
}

#[derive(Serialize)]
struct BenchReadingAnswer {
    value: f64,
    confidence_95: [f64; 2],
}

fn reversals(found: &ReversalReading) -> ReversalsAnswer {
    let reading = |(value, confidence_95)| BenchReadingAnswer { value, confidence_95 };
    ReversalsAnswer {
        hysteresis_v: reading(found.hysteresis),
        threshold_v: reading(found.threshold),
        hysteresis_share_of_nominal: found.hysteresis.0 / found.nominal_voltage,
        threshold_share_of_nominal: found.threshold.0 / found.nominal_voltage,
    }
}

#[derive(Serialize)]
struct BenchSignalAnswer {
    name: &'static str,
    unit: &'static str,
    range: [f64; 2],
}

/// A column of a test's table: name in SI, unit of the table, and the source of its value.
pub(super) struct TableSignal {
    /// The name of the table's column.
    pub(super) column: &'static str,
    /// For people.
    pub(super) quantity: &'static str,
    /// Of the table.
    pub(super) unit: DisplayUnit,
    /// SI unit.
    pub(super) si: &'static str,
    pub(super) of: fn(&BenchRow) -> f64,
}

/// The signals that a test records, without time.
pub(super) fn signals(run: &BenchRun) -> Vec<TableSignal> {
    let (volt, bar, litres) = (DisplayUnit::VOLT, DisplayUnit::BAR, DisplayUnit::LITRE_PER_MINUTE);
    let signal = |column, quantity, unit, si, of| TableSignal { column, quantity, unit, si, of };
    let [leak, flow] = run.series.test().measures_flow();
    let mut signals: Vec<TableSignal> = vec![
        signal("command_v", "command", volt, "V", |row: &BenchRow| row.command),
        signal("supply_pressure_bar", "supply pressure", bar, "Pa", |row: &BenchRow| row.supply_pressure),
        signal("pressure_a_bar", "pressure at A", bar, "Pa", |row: &BenchRow| row.pressure_a),
        signal("pressure_b_bar", "pressure at B", bar, "Pa", |row: &BenchRow| row.pressure_b),
    ];
    if leak {
        signals
            .push(signal("leak_flow_l_per_min", "leakage", litres, "m3/s", |row: &BenchRow| row.leak_flow));
    }
    if flow {
        signals.push(signal("flow_l_per_min", "flow", litres, "m3/s", |row: &BenchRow| row.flow));
    }
    if run.rows.iter().any(|row| row.oil_temperature.is_some()) {
        let degrees = DisplayUnit::DEGREE_CELSIUS;
        let of = |row: &BenchRow| row.oil_temperature.unwrap_or(f64::NAN);
        signals.push(signal("oil_temperature_degC", "oil temperature", degrees, "degC", of));
    }
    signals
}

/// Smallest and largest recorded value, SI.
pub(super) fn range(run: &BenchRun, signal: &TableSignal) -> [f64; 2] {
    let values = || run.rows.iter().map(|row| (signal.of)(row));
    [values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max)]
}

fn file_name(run: &BenchRun) -> String {
    format!("{}.csv", run.series.name())
}

/// The JSON object of `bench`.
pub fn json(
    loaded: &Loaded,
    remarks: Vec<&'static str>,
    runs: &[BenchRun],
    lines: &[LineRun],
    of_friction: &[FrictionRun],
) -> String {
    let test = |run: &BenchRun| BenchTestAnswer {
        name: run.series.name(),
        file: file_name(run),
        rows: run.rows.len(),
        duration_s: run.rows.last().map_or(0.0, |row| row.time),
        signals: signals(run)
            .iter()
            .map(|signal| BenchSignalAnswer {
                name: signal.quantity,
                unit: signal.si,
                range: range(run, signal),
            })
            .collect(),
        lowest_supply_pressure_pa: run.lowest_supply_pressure,
        reversals: run.reversals.as_ref().map(reversals),
    };
    let tests = runs.iter().map(test).collect();
    let line_tests = lines.iter().map(|run| Json::from(line_test(run))).collect();
    let friction_runs = friction::answers(of_friction);
    answer::json("bench", loaded, BenchAnswer { remarks, tests, line_tests, friction_runs })
}

/// The tables, a file for each test.
pub fn files(runs: &[BenchRun], of_friction: &[FrictionRun]) -> Vec<OutputFile> {
    // nothing that is written to memory can fail
    let file = |run: &BenchRun| OutputFile { name: file_name(run), bytes: table(run).unwrap_or_default() };
    runs.iter().map(file).chain(friction::files(of_friction)).collect()
}

fn table(run: &BenchRun) -> io::Result<Vec<u8>> {
    let signals = signals(run);
    let columns: Vec<&str> =
        std::iter::once("time_s").chain(signals.iter().map(|signal| signal.column)).collect();
    let mut table = NumberTable::new(Vec::new(), TableFormat::Csv, &columns)?;
    for row in &run.rows {
        let shown = signals.iter().map(|signal| signal.unit.of((signal.of)(row)));
        table.row(&std::iter::once(row.time).chain(shown).collect::<Vec<f64>>())?;
    }
    table.finish()
}
