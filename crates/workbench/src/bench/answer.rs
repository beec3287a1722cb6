//! The answer of `bench`, and the tables of its tests.

use phea_engineering::bench::{BenchRow, BenchRun, BenchSeries, FrictionRun, ReversalReading};
use phea_engineering::estimate::Estimate;
use phea_engineering::line_test::LineRun;

use super::friction;
use super::line::{LineTestTableAnswer, line_test};
use super::table::{BenchColumn, BenchRecordAnswer, BenchTable};
use crate::answer::{Answer, OutputFile};
use crate::quantity::DisplayUnit;

/// What a test records.
pub(super) fn recorded(run: &BenchRun) -> BenchTable {
    let (volt, bar, litres) = (DisplayUnit::VOLT, DisplayUnit::BAR, DisplayUnit::LITRE_PER_MINUTE);
    let column = |names, unit, of: fn(&BenchRow) -> f64| {
        BenchColumn::of(names, unit, run.rows.iter().map(of).collect())
    };
    let [leak, flow] = run.series.test().measures_flow();
    let mut columns = vec![
        column(["command_v", "command", "V"], volt, |row| row.command),
        column(["supply_pressure_bar", "supply pressure", "Pa"], bar, |row| row.supply_pressure),
        column(["pressure_a_bar", "pressure at A", "Pa"], bar, |row| row.pressure_a),
        column(["pressure_b_bar", "pressure at B", "Pa"], bar, |row| row.pressure_b),
    ];
    if leak {
        columns.push(column(["leak_flow_l_per_min", "leakage", "m3/s"], litres, |row| row.leak_flow));
    }
    if flow {
        columns.push(column(["flow_l_per_min", "flow", "m3/s"], litres, |row| row.flow));
    }
    if run.rows.iter().any(|row| row.oil_temperature.is_some()) {
        let names = ["oil_temperature_degC", "oil temperature", "degC"];
        let of = |row: &BenchRow| row.oil_temperature.unwrap_or(f64::NAN);
        columns.push(column(names, DisplayUnit::DEGREE_CELSIUS, of));
    }
    let times = run.rows.iter().map(|row| row.time).collect();
    BenchTable { name: run.series.name(), title: title(run.series), times, columns }
}

fn title(series: BenchSeries) -> &'static str {
    match series {
        BenchSeries::Leakage => "Internal leakage, ports blocked (ISO 10770-1, 8.1.3)",
        BenchSeries::Metering => "Metering, ports joined through a meter (ISO 10770-1, 8.1.4)",
        BenchSeries::PressureGain => "Pressure gain around null, ports blocked",
        BenchSeries::LowFlowMetering => "Metering with the meter of small flows (ISO 10770-1, 8.1.4)",
        BenchSeries::Reversals => "Hysteresis and threshold, ports joined through a meter (ISO 10770-1)",
    }
}

/// Answer of `bench`.
#[derive(Answer)]
pub(crate) struct BenchAnswer {
    /// Remarks on the parts of the project that the tests leave out, if any.
    #[answer(optional)]
    remarks: Option<Vec<&'static str>>,
    /// Static tests of the servovalve.
    tests: Vec<BenchTestAnswer>,
    /// Tests of a blocked line, if `[bench.line]` requests them.
    #[answer(optional)]
    line_tests: Option<Vec<LineTestTableAnswer>>,
    /// Runs of the cylinder for its friction, if `[bench.friction]` requests them.
    #[answer(optional)]
    friction_runs: Option<Vec<BenchRecordAnswer>>,
}

/// Static test of the servovalve.
#[derive(Answer)]
struct BenchTestAnswer {
    #[answer(flatten)]
    record: BenchRecordAnswer,
    /// Lowest supply pressure during the test, without noise.
    lowest_supply_pressure_pa: f64,
    /// Hysteresis and threshold of the valve, only of the test of reversals.
    #[answer(optional)]
    reversals: Option<ReversalsAnswer>,
}

/// Hysteresis and threshold of the valve, as the rows of the test show them.
#[derive(Answer)]
struct ReversalsAnswer {
    /// Greatest difference of two commands with the same flow over the cycle, including the
    /// threshold.
    hysteresis_v: BenchEstimateAnswer,
    /// Change of the command after a reversal before the spool moves.
    threshold_v: BenchEstimateAnswer,
    /// Hysteresis over the command of full opening.
    hysteresis_fraction_of_nominal: f64,
    /// Threshold over the command of full opening.
    threshold_fraction_of_nominal: f64,
}

/// Estimate of a number.
#[derive(Answer)]
struct BenchEstimateAnswer {
    /// Most likely value.
    value: f64,
    /// Bounds of the 95 % confidence interval; infinite if nothing limits it.
    #[answer(interval)]
    confidence_95: [f64; 2],
}

fn reversals(found: &ReversalReading) -> ReversalsAnswer {
    let reading = |one: Estimate| BenchEstimateAnswer { value: one.value, confidence_95: one.interval };
    ReversalsAnswer {
        hysteresis_v: reading(found.hysteresis),
        threshold_v: reading(found.threshold),
        hysteresis_fraction_of_nominal: found.hysteresis.value / found.nominal_voltage,
        threshold_fraction_of_nominal: found.threshold.value / found.nominal_voltage,
    }
}

/// Answer of `bench`.
pub(crate) fn body(
    remarks: Vec<&'static str>,
    runs: &[BenchRun],
    lines: &[LineRun],
    of_friction: &[FrictionRun],
) -> BenchAnswer {
    let test = |run: &BenchRun| BenchTestAnswer {
        record: recorded(run).answer(),
        lowest_supply_pressure_pa: run.lowest_supply_pressure,
        reversals: run.reversals.as_ref().map(reversals),
    };
    let friction_runs = of_friction.iter().map(|run| friction::recorded(run).answer());
    BenchAnswer {
        remarks: some(remarks),
        tests: runs.iter().map(test).collect(),
        line_tests: some(lines.iter().map(line_test).collect()),
        friction_runs: some(friction_runs.collect()),
    }
}

/// A list that is not empty.
fn some<Item>(list: Vec<Item>) -> Option<Vec<Item>> {
    (!list.is_empty()).then_some(list)
}

/// The tables, a file for each test.
pub fn files(runs: &[BenchRun], of_friction: &[FrictionRun]) -> Vec<OutputFile> {
    let tables = runs.iter().map(recorded).chain(of_friction.iter().map(friction::recorded));
    tables.map(|table| table.file()).collect()
}
