//! The metrics of an event in tables and answers.

use super::{Metric, Metrics, PerMetric, Unmeasured, unmeasured_words};
use crate::answer::Object;
use crate::document::Cell;
use crate::quantity::{DisplayUnit, MotionKind, Units};

/// The unit in which people read a metric.
pub(crate) fn shown_in(metric: Metric, units: Units) -> DisplayUnit {
    units.of(metric.dimension())
}

/// A value of a metric.
pub(crate) fn metric_cell(metric: Metric, value: f64, units: Units) -> Cell {
    let small = matches!(metric, Metric::SteadyStateError | Metric::DisturbancePeak);
    let value = if small { small_as_zero(value) } else { value };
    Cell::quantity(value, metric.digits(), shown_in(metric, units))
}

/// The label of a metric, for the settling time with its band: `settling (1 %)`; with each band
/// once if the compared runs have different bands.
pub(crate) fn label_within(
    metric: Metric,
    bands_percent: impl IntoIterator<Item = f64>,
    motion: MotionKind,
) -> String {
    match metric {
        Metric::SettlingTime => settling_within(bands_percent),
        other => other.label(motion).to_string(),
    }
}

/// The label of a settling time, with its bands: see [`label_within`].
pub(crate) fn settling_within(bands_percent: impl IntoIterator<Item = f64>) -> String {
    let mut bands: Vec<String> = Vec::new();
    for band in bands_percent.into_iter().map(|band| format!("{band} %")) {
        if !bands.contains(&band) {
            bands.push(band);
        }
    }
    let label = Metric::SettlingTime.label(MotionKind::Linear);
    if bands.is_empty() { label.to_string() } else { format!("{label} ({})", bands.join(", ")) }
}

/// The cell of each metric, with its unit.
pub(crate) fn cells_of(metrics: &Metrics, units: Units) -> PerMetric<Cell> {
    PerMetric::of(|metric| match metrics.get(metric) {
        Ok(value) => metric_cell(metric, value, units),
        Err(Unmeasured::NotSettled) if metric == Metric::SettlingTime => "not settled".into(),
        Err(_) => Cell::Missing,
    })
}

/// An error of the force below a millinewton is due to the integration, not to the loop.
fn small_as_zero(error_n: f64) -> f64 {
    if error_n.abs() < 1e-3 { 0.0 } else { error_n }
}

/// The metrics in an answer: the value of each, or the reason why there is none.
pub(crate) fn metrics_row(metrics: &Metrics, motion: MotionKind) -> Object {
    Metric::ALL.into_iter().fold(Object::new(), |row, metric| {
        let band = (metric == Metric::SettlingTime).then_some(metrics.settling_band_percent);
        row.told(metric.quantity(), metrics.get(metric).map_err(|why| unmeasured_words(why, motion)))
            .maybe("settling_band_percent", band)
    })
}
