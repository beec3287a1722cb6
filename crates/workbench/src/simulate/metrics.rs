//! The metrics of an event in tables and answers.

use phea_engineering::simulate::{Metric, Metrics, PerMetric, Unmeasured};

use super::unmeasured_words;
use crate::answer::{Answer, Reasoned};
use crate::document::Cell;
use crate::quantity::{DisplayUnit, MotionKind, Units};

/// The unit in which people read a metric.
pub(crate) fn shown_in(metric: Metric, units: Units) -> DisplayUnit {
    units.of(metric.dimension())
}

/// A value of a metric.
pub(crate) fn metric_cell(metric: Metric, value: f64, units: Units) -> Cell {
    let cell = Cell::quantity(value, metric.digits(), shown_in(metric, units));
    match metric {
        Metric::SteadyStateError | Metric::DisturbancePeak => cell.zero_below(NEGLIGIBLE_N),
        _ => cell,
    }
}

/// The label of a metric, for the settling time with its band: `settling (1 %)`; with each band
/// once if the compared runs have different bands.
pub(crate) fn label_within(
    metric: Metric,
    bands_percent: impl IntoIterator<Item = f64>,
    motion: MotionKind,
) -> String {
    label_cell(metric, bands_percent, motion).text()
}

/// The label of a metric in a cell.
pub(super) fn label_cell(
    metric: Metric,
    bands_percent: impl IntoIterator<Item = f64>,
    motion: MotionKind,
) -> Cell {
    match metric {
        Metric::SettlingTime => settling_cell(bands_percent),
        other => other.label(motion).into(),
    }
}

/// The label of a settling time, with its bands: see [`label_within`].
pub(crate) fn settling_cell(bands_percent: impl IntoIterator<Item = f64>) -> Cell {
    let mut bands: Vec<Cell> = Vec::new();
    for band in bands_percent.into_iter().map(|band| Cell::short(band, STATED, DisplayUnit::IN_PERCENT)) {
        if !bands.contains(&band) {
            bands.push(band);
        }
    }
    let label = Cell::from(Metric::SettlingTime.label(MotionKind::Linear));
    if bands.is_empty() { label } else { label.then(Cell::listed(bands, ", ").between(" (", ")")) }
}

/// Digits of a number that is printed as it is stated.
pub(super) const STATED: usize = 17;

/// The cell of each metric, with its unit.
pub(crate) fn cells_of(metrics: &Metrics, units: Units) -> PerMetric<Cell> {
    PerMetric::of(|metric| match metrics.get(metric) {
        Ok(value) => metric_cell(metric, value, units),
        Err(Unmeasured::NotSettled) if metric == Metric::SettlingTime => "not settled".into(),
        Err(_) => Cell::Missing,
    })
}

/// Error of the force below which it is due to the integration, not to the loop.
const NEGLIGIBLE_N: f64 = 1e-3;

/// Metrics of an event, of the solution itself and not of its samples.
#[derive(Answer)]
pub(crate) struct EventMetricsAnswer {
    /// Excess of the force over the new reference, of the step.
    overshoot_percent: Reasoned<f64>,
    /// Time from 10 to 90 percent of the step, each where the force first reaches it.
    rise_time_s: Reasoned<f64>,
    /// Time from the event until the force remains within the band around the reference, for the
    /// last tenth of the time to the next event at least.
    settling_time_s: Reasoned<f64>,
    /// Half width of the band of the settling time, of the step, or of the reference if the load
    /// disturbs it.
    settling_band_percent: f64,
    /// Largest magnitude of the difference between force and reference while the load moves or an
    /// external force acts, and afterwards.
    #[answer(key = Metric::DisturbancePeak.quantity())]
    disturbance_peak: Reasoned<f64>,
    /// Largest magnitude of the difference between force and reference while the reference moves.
    #[answer(key = Metric::TrackingErrorPeak.quantity())]
    tracking_error_peak: Reasoned<f64>,
    /// Largest magnitude of the force if there is no reference.
    #[answer(key = Metric::ForcePeak.quantity())]
    force_peak: Reasoned<f64>,
    /// Reference less force at the end of the event.
    #[answer(key = Metric::SteadyStateError.quantity())]
    steady_state_error: Reasoned<f64>,
    /// Largest magnitude of the command.
    control_peak_v: Reasoned<f64>,
    /// Root mean square of the command.
    control_rms_v: Reasoned<f64>,
}

/// The metrics in an answer: the value of each, or the reason why there is none.
pub(super) fn metrics_answer(metrics: &Metrics, motion: MotionKind) -> EventMetricsAnswer {
    let metric = |metric| Reasoned::of(metrics.get(metric).map_err(|why| unmeasured_words(why, motion)));
    EventMetricsAnswer {
        overshoot_percent: metric(Metric::Overshoot),
        rise_time_s: metric(Metric::RiseTime),
        settling_time_s: metric(Metric::SettlingTime),
        settling_band_percent: metrics.settling_band_percent,
        disturbance_peak: metric(Metric::DisturbancePeak),
        tracking_error_peak: metric(Metric::TrackingErrorPeak),
        force_peak: metric(Metric::ForcePeak),
        steady_state_error: metric(Metric::SteadyStateError),
        control_peak_v: metric(Metric::ControlPeak),
        control_rms_v: metric(Metric::ControlRms),
    }
}
