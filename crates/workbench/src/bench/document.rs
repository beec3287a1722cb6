//! The static tests of a valve for people.

use super::answer::{range, signals};
use super::{BenchRun, StaticTest};
use crate::document::{Cell, Document, Table};
use crate::project::Loaded;
use crate::quantity::{PRESSURE, TIME, display};

/// A table for each test.
pub fn text(loaded: &Loaded, runs: &[BenchRun]) -> String {
    let mut out = Document::default();
    for run in runs {
        let rows = signals(run).into_iter().map(|signal| {
            let [least, most] = range(run, &signal);
            [
                Cell::from(signal.quantity),
                Cell::number(signal.unit.of(least), 4),
                Cell::number(signal.unit.of(most), 4),
                Cell::from(signal.unit.symbol),
            ]
        });
        out.section(title(run.test), Table::new(["recorded", "least", "most", "unit"]).with(rows));
        let duration = run.rows.last().map_or(0.0, |row| row.time);
        out.sentences([format!("{} rows in {}.", run.rows.len(), display(duration, &TIME, 4))]);
        out.sentences(sag(loaded, run));
    }
    out.text()
}

fn title(test: StaticTest) -> &'static str {
    match test {
        StaticTest::Leakage => "Internal leakage, ports blocked (ISO 10770-1, 8.1.3)",
        StaticTest::Metering => "Metering, ports joined through a meter (ISO 10770-1, 8.1.4)",
        StaticTest::PressureGain => "Pressure gain around null, ports blocked",
    }
}

/// That the pump did not keep the pressure.
fn sag(loaded: &Loaded, run: &BenchRun) -> Option<String> {
    let stated = loaded.project.actuator.as_ref()?.supply.pressure;
    let (least, at) = (run.lowest_supply_pressure, |value| display(value, &PRESSURE, 4));
    (least < 0.99 * stated).then(|| {
        format!("The pump does not keep {}: the supply pressure falls to {}.", at(stated), at(least))
    })
}
