//! The tests of the bench for programs, and their tables.

use super::line::line_test;
use super::table::{BenchColumn, BenchTable};
use super::{BenchRow, BenchRun, BenchSeries, FrictionRun, ReversalReading, friction};
use crate::answer::{Json, Object, OutputFile};
use crate::estimate::Estimate;
use crate::line_test::LineRun;
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

fn reversals(found: &ReversalReading) -> Object {
    let reading = |one: Estimate| Object::new().with("value", one.value).with("confidence_95", one.interval);
    Object::new()
        .with("hysteresis_v", reading(found.hysteresis))
        .with("threshold_v", reading(found.threshold))
        .with("hysteresis_share_of_nominal", found.hysteresis.value / found.nominal_voltage)
        .with("threshold_share_of_nominal", found.threshold.value / found.nominal_voltage)
}

/// What `bench` says to programs.
pub(crate) fn body(
    remarks: Vec<&'static str>,
    runs: &[BenchRun],
    lines: &[LineRun],
    of_friction: &[FrictionRun],
) -> Object {
    let test = |run: &BenchRun| {
        recorded(run)
            .json_of_signals()
            .with("lowest_supply_pressure_pa", run.lowest_supply_pressure)
            .maybe("reversals", run.reversals.as_ref().map(reversals))
    };
    let some = |list: Vec<Json>| (!list.is_empty()).then_some(list);
    let out = Object::new()
        .maybe("remarks", some(remarks.into_iter().map(Json::from).collect()))
        .each("tests", runs, test)
        .maybe("line_tests", some(lines.iter().map(|run| line_test(run).into()).collect()));
    let of_friction = of_friction.iter().map(|run| friction::recorded(run).json_of_signals().into());
    out.maybe("friction_runs", some(of_friction.collect()))
}

/// The tables, a file for each test.
pub fn files(runs: &[BenchRun], of_friction: &[FrictionRun]) -> Vec<OutputFile> {
    let tables = runs.iter().map(recorded).chain(of_friction.iter().map(friction::recorded));
    tables.map(|table| table.file()).collect()
}
