//! The runs of a cylinder for its friction.

use phea_engineering::bench::{FrictionRow, FrictionRun, FrictionSeries};

use super::table::{BenchColumn, BenchTable};
use crate::quantity::DisplayUnit;

/// The record of a run.
pub(super) fn recorded(run: &FrictionRun) -> BenchTable {
    let column = |names, unit, of: fn(&FrictionRow) -> f64| {
        BenchColumn::of(names, unit, run.rows.iter().map(of).collect())
    };
    let columns = vec![
        column(["position_mm", "position", "m"], DisplayUnit::MILLIMETRE, |row| row.position),
        column(["pressure_a_bar", "pressure at A", "Pa"], DisplayUnit::BAR, |row| row.pressure_a),
        column(["pressure_b_bar", "pressure at B", "Pa"], DisplayUnit::BAR, |row| row.pressure_b),
    ];
    let times = run.rows.iter().map(|row| row.time).collect();
    BenchTable { name: run.series.name(), title: title(run.series), times, columns }
}

fn title(series: FrictionSeries) -> &'static str {
    match series {
        FrictionSeries::Sliding => "Cylinder at constant velocities, both ways",
        FrictionSeries::Breakaway => "Cylinder pressed from A to B until it breaks away",
        FrictionSeries::BreakawayBack => "Cylinder pressed from B to A until it breaks away",
        FrictionSeries::Shaken => "Cylinder shaken before it breaks away",
    }
}
