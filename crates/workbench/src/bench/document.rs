//! The tests of the bench for people.

use phea_engineering::bench::{BenchRun, BenchSeries, FrictionRun, ReversalReading};
use phea_engineering::estimate::Estimate;
use phea_engineering::line_test::LineRun;

use super::answer::recorded;
use super::{friction, line};
use crate::answer::significant;
use crate::document::Document;
use crate::project::Loaded;
use crate::quantity::{PRESSURE, display};

/// A table for each test.
pub(crate) fn document(
    loaded: &Loaded,
    remarks: &[&str],
    runs: &[BenchRun],
    of_friction: &[FrictionRun],
    lines: &[LineRun],
) -> Document {
    let mut out = Document::default();
    out.sentences(remarks.iter().map(|remark| remark.to_string()));
    for run in runs {
        recorded(run).write_ranges(4, &mut out);
        out.sentences(sag(loaded, run));
        if run.series == BenchSeries::Reversals {
            out.sentences(reversals(run.reversals.as_ref()));
        }
    }
    for run in of_friction {
        friction::recorded(run).write_ranges(6, &mut out);
    }
    for run in lines {
        line::recorded(run).write_ranges(4, &mut out);
    }
    out
}

/// Warning that the pump did not maintain the pressure.
fn sag(loaded: &Loaded, run: &BenchRun) -> Option<String> {
    let stated = loaded.project.actuator.as_ref()?.supply.pressure;
    let (least, at) = (run.lowest_supply_pressure, |value| display(value, &PRESSURE, 4));
    (least < 0.99 * stated).then(|| {
        format!("The pump does not keep {}: the supply pressure falls to {}.", at(stated), at(least))
    })
}

/// Hysteresis and threshold, fractions of the nominal voltage.
fn reversals(found: Option<&ReversalReading>) -> Vec<String> {
    let Some(found) = found else {
        return vec![
            "The meter reads zero in nearly all rows: neither hysteresis nor threshold can be read."
                .to_string(),
        ];
    };
    let percent_of_nominal = |value: f64| significant(100.0 * value / found.nominal_voltage, 3);
    let sentence = |name: &str, Estimate { value, interval: [low, high] }: Estimate| {
        format!(
            "{name}: {} V, {} % of the nominal voltage (95 %: {} to {} %).",
            significant(value, 3),
            percent_of_nominal(value),
            percent_of_nominal(low),
            percent_of_nominal(high)
        )
    };
    vec![
        sentence("Hysteresis, threshold included", found.hysteresis),
        sentence("Threshold, what a reversal takes before the flow changes", found.threshold),
    ]
}
