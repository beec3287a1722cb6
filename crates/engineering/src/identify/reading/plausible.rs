//! Implausible numbers for a test of a valve: nearly always in another unit than the stated one.

use super::error::{ColumnSetting, RecordedTestError, RecordedTestHint, SignalInWords};
use super::{Known, Taken};
use crate::project::{Findings, RawFinding, TestSignal};
use crate::quantity::{PRESSURE, UnitScale, display};
use crate::table::{Column, MeasuredTable};

/// Usual limits of the numbers of a column, SI: least and greatest.
fn usual(signal: TestSignal, nominal_voltage: f64) -> [f64; 2] {
    match signal {
        // the whole test lasts half a second to a day
        TestSignal::Time => [0.5, 1e5],
        TestSignal::Command => [1e-3 * nominal_voltage, BEYOND_NOMINAL * nominal_voltage],
        TestSignal::SupplyPressure => [1e5, 7e7],
        TestSignal::TankPressure => [0.0, 5e7],
        TestSignal::PressureA | TestSignal::PressureB => [1e3, 7e7],
        TestSignal::LeakFlow => [1e-9, 1e-2],
        TestSignal::Flow => [1e-8, 0.1],
        TestSignal::OilTemperature => [0.0, 150.0],
    }
}

/// Ratio of the greatest command to the nominal one.
const BEYOND_NOMINAL: f64 = 1.1;
/// Ratio of the greatest pressure of a port to the supply, for transducers that disagree.
const BEYOND_SUPPLY: f64 = 1.25;
/// Least fraction of the supply pressure that a port reaches in a test.
const LEAST_OF_SUPPLY: f64 = 1e-3;

/// Greatest magnitude of a single value, SI.
pub(super) fn greatest(signal: TestSignal, nominal_voltage: f64) -> f64 {
    match signal {
        TestSignal::Time => 1e7,
        TestSignal::Command => BEYOND_NOMINAL * nominal_voltage,
        TestSignal::LeakFlow | TestSignal::Flow => 0.1,
        TestSignal::OilTemperature => 200.0,
        _ => 2e8,
    }
}

/// Rejects columns whose numbers reach values that no test reaches, and single values that are
/// impossible.
pub(super) fn check(
    table: &MeasuredTable,
    columns: &[(TestSignal, Column)],
    taken: &Taken,
    rows: &[usize],
    known: &Known,
    findings: &mut Findings,
) {
    let nominal_voltage = known.nominal_voltage;
    let supply = taken.of(TestSignal::SupplyPressure).map(reached).or(known.supply_pressure);
    for (signal, column) in columns {
        let Some(values) = taken.of(*signal) else { continue };
        if *signal == TestSignal::Command && values.iter().all(|value| Some(value) == values.first()) {
            let place = table.headings.get(column.index).map(|heading| heading.place).unwrap_or_default();
            findings.push(RawFinding::error(place, RecordedTestError::CommandNeverMoves.to_string()));
            continue;
        }
        let level = match signal {
            TestSignal::Time => duration(values),
            // a meter at rest reads zero
            TestSignal::LeakFlow => reached(values.iter().filter(|value| **value != 0.0)),
            _ => reached(values),
        };
        let mut limits = usual(*signal, nominal_voltage);
        let is_port = matches!(signal, TestSignal::PressureA | TestSignal::PressureB);
        let of_supply = supply.filter(|supply| is_port && (1e5..=7e7).contains(supply));
        if let Some(supply) = of_supply {
            limits = [LEAST_OF_SUPPLY * supply, BEYOND_SUPPLY * supply];
        }
        if !(limits[0]..=limits[1]).contains(&level) {
            findings.push(implausible(table, *signal, column, level, limits, of_supply));
            continue;
        }
        if std::ptr::eq(signal.dimension(), &PRESSURE) {
            table.check_gauge(column, values, |row| rows.get(row).copied().unwrap_or(0), findings);
        }
        let most = greatest(*signal, nominal_voltage);
        for (row, value) in rows.iter().zip(values).filter(|(_, value)| value.abs() > most) {
            let dimension = signal.dimension();
            let written = match table.cell(*row, column, findings) {
                "" => display(*value, dimension, 3),
                text => format!("{text} {}", column.unit),
            };
            let message =
                RecordedTestError::ImplausibleValue { written, signal: SignalInWords::from(*signal) };
            let found = table.error(*row, column, message.to_string(), findings);
            findings.push(found.expected(format!("at most {}", display(most, dimension, 3))));
        }
    }
}

/// Magnitude that a twentieth of the values exceeds; zero without values.
fn reached<'a>(values: impl IntoIterator<Item = &'a f64>) -> f64 {
    let magnitudes = values.into_iter().map(|value| value.abs());
    let mut magnitudes: Vec<f64> = magnitudes.filter(|value| !value.is_nan()).collect();
    let index = magnitudes.len() * 19 / 20;
    if index >= magnitudes.len() {
        return 0.0;
    }
    *magnitudes.select_nth_unstable_by(index, f64::total_cmp).1
}

fn duration(times: &[f64]) -> f64 {
    times.first().zip(times.last()).map_or(0.0, |(first, last)| last - first)
}

/// Finding for a column with values that no test reaches, with the units in which they would be
/// plausible.
fn implausible(
    table: &MeasuredTable,
    signal: TestSignal,
    column: &Column,
    level: f64,
    limits: [f64; 2],
    supply: Option<f64>,
) -> RawFinding {
    let shown = |value: f64| display(value, signal.dimension(), 3);
    let heading = table.heading(column).to_string();
    let message = match (signal, supply) {
        (TestSignal::Time, _) => RecordedTestError::ImplausibleDuration { heading, duration: level },
        (TestSignal::Command, _) => {
            let nominal = limits[1] / BEYOND_NOMINAL;
            RecordedTestError::ImplausibleCommand { heading, reached: level, nominal }
        }
        (_, Some(supply)) => RecordedTestError::ImplausiblePort { heading, reached: level, supply },
        _ => RecordedTestError::ImplausibleColumn { heading, reached: level, signal },
    };
    let place = table.headings.get(column.index).map(|heading| heading.place).unwrap_or_default();
    let expected = format!("{} to {}", shown(limits[0]), shown(limits[1]));
    let found = RawFinding::error(place, message.to_string()).expected(expected);
    let units = other_units(signal, column, level, limits);
    let hint = match units.as_slice() {
        [] if signal == TestSignal::Command => RecordedTestHint::NominalVoltage,
        [] => RecordedTestHint::OtherColumn,
        several => {
            let units = match several {
                [others @ .., last] if !others.is_empty() => format!("{} or {last}", others.join(", ")),
                several => several.concat(),
            };
            let setting = ColumnSetting {
                key: signal.name(),
                heading: table.heading(column).to_string(),
                unit: several.first().copied().unwrap_or_default().to_string(),
            };
            RecordedTestHint::PlausibleUnits { units, setting }
        }
    };
    found.help(hint.to_string())
}

/// Units in which the numbers of a column would be plausible.
fn other_units(signal: TestSignal, column: &Column, level: f64, limits: [f64; 2]) -> Vec<&'static str> {
    let units: &[&'static str] = match signal {
        TestSignal::Time => &["s", "ms", "min", "us"],
        TestSignal::Command => &["V", "mV"],
        TestSignal::LeakFlow | TestSignal::Flow => &["L/min", "mL/min", "L/s", "cm3/s", "m3/s"],
        TestSignal::OilTemperature => &["degC"],
        _ => &["bar", "psi", "MPa", "kPa", "Pa"],
    };
    let in_si = |unit: &str| UnitScale::new(unit, signal.dimension()).ok()?.read("1");
    let Some(stated) = in_si(&column.unit) else { return Vec::new() };
    let would_do = |unit: &&&'static str| {
        in_si(unit).is_some_and(|other| (limits[0]..=limits[1]).contains(&(level / stated * other)))
    };
    units.iter().filter(would_do).copied().collect()
}
