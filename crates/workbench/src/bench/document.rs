//! The tests of the bench for people.

use super::answer::{range, signals};
use super::{BenchRun, BenchSeries, FrictionRun, ReversalReading, friction};
use crate::answer::significant;
use crate::document::{Cell, Document, Table};
use crate::project::Loaded;
use crate::quantity::{PRESSURE, TIME, display};

/// A table for each test.
pub fn text(loaded: &Loaded, remarks: &[&str], runs: &[BenchRun], of_friction: &[FrictionRun]) -> String {
    let mut out = Document::default();
    out.sentences(remarks.iter().map(|remark| remark.to_string()));
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
        out.section(title(run.series), Table::new(["recorded", "least", "most", "unit"]).with(rows));
        let duration = run.rows.last().map_or(0.0, |row| row.time);
        out.sentences([format!("{} rows in {}.", run.rows.len(), display(duration, &TIME, 4))]);
        out.sentences(sag(loaded, run));
        if run.series == BenchSeries::Reversals {
            out.sentences(reversals(run.reversals.as_ref()));
        }
    }
    friction::tell(of_friction, &mut out);
    out.text()
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

/// That the pump did not keep the pressure.
fn sag(loaded: &Loaded, run: &BenchRun) -> Option<String> {
    let stated = loaded.project.actuator.as_ref()?.supply.pressure;
    let (least, at) = (run.lowest_supply_pressure, |value| display(value, &PRESSURE, 4));
    (least < 0.99 * stated).then(|| {
        format!("The pump does not keep {}: the supply pressure falls to {}.", at(stated), at(least))
    })
}

/// Hysteresis and threshold, as shares of the nominal voltage.
fn reversals(found: Option<&ReversalReading>) -> Vec<String> {
    let Some(found) = found else {
        return vec![
            "The meter stands still in nearly all rows: neither hysteresis nor threshold can be read."
                .to_string(),
        ];
    };
    let share = |value: f64| significant(100.0 * value / found.nominal_voltage, 3);
    let sentence = |name: &str, (value, [low, high]): (f64, [f64; 2])| {
        format!(
            "{name}: {} V, {} % of the nominal voltage (95 %: {} to {} %).",
            significant(value, 3),
            share(value),
            share(low),
            share(high)
        )
    };
    vec![
        sentence("Hysteresis, threshold included", found.hysteresis),
        sentence("Threshold, what a reversal takes before the flow changes", found.threshold),
    ]
}
