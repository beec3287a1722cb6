//! The metrics of an event: words, units and digits of each, for tables and for answers.

use super::{Metrics, NOT_SETTLED};
use crate::answer::Object;
use crate::document::Cell;
use crate::quantity::{DisplayUnit, Units};

/// How a metric is printed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Metric {
    /// Its name in answers.
    pub(crate) key: &'static str,
    /// For people.
    pub(crate) word: &'static str,
    /// Its unit, that of the answer.
    unit: &'static str,
    digits: usize,
}

const fn metric(key: &'static str, word: &'static str, unit: &'static str, digits: usize) -> Metric {
    Metric { key, word, unit, digits }
}

/// In the order of [`Metrics::named`].
pub(crate) const METRICS: [Metric; 9] = [
    metric("overshoot_percent", "overshoot", "%", 3),
    metric("rise_time_s", "rise", "s", 3),
    metric("settling_time_s", "settling", "s", 3),
    metric("disturbance_peak_n", "disturbance peak", "N", 4),
    metric("tracking_error_peak_n", "tracking error peak", "N", 4),
    metric("force_peak_n", "force peak", "N", 4),
    metric("steady_state_error_n", "steady-state error", "N", 2),
    metric("control_peak_v", "control peak", "V", 3),
    metric("control_rms_v", "control rms", "V", 3),
];

/// Indices of two metrics.
pub(crate) const OVERSHOOT: usize = 0;
pub(crate) const SETTLING: usize = 2;

/// The metric with this name in answers.
pub(crate) fn metric_of(key: &str) -> Option<&'static Metric> {
    METRICS.iter().find(|metric| metric.key == key)
}

impl Metric {
    /// A value of it.
    pub(crate) fn cell(&self, value: f64, units: Units) -> Cell {
        let small = ["steady_state_error_n", "disturbance_peak_n"].contains(&self.key);
        let value = if small { small_as_zero(value) } else { value };
        Cell::quantity(value, self.digits, self.shown_in(units))
    }

    /// Its word, that of the settling time with its band: `settling (1 %)`; with each band once
    /// where it differs between what is compared.
    pub(crate) fn word_within(&self, bands_percent: impl IntoIterator<Item = f64>) -> String {
        match self.key == METRICS[SETTLING].key {
            true => settling_within(bands_percent),
            false => self.word.to_string(),
        }
    }

    /// The unit in which people read it.
    pub(crate) fn shown_in(&self, units: Units) -> DisplayUnit {
        match self.unit {
            "N" => units.force,
            symbol => DisplayUnit { symbol, in_si: 1.0 },
        }
    }
}

/// The word for a settling time, with its bands: see [`Metric::word_within`].
pub(crate) fn settling_within(bands_percent: impl IntoIterator<Item = f64>) -> String {
    let mut bands: Vec<String> = Vec::new();
    for band in bands_percent.into_iter().map(|band| format!("{band} %")) {
        if !bands.contains(&band) {
            bands.push(band);
        }
    }
    let word = METRICS[SETTLING].word;
    if bands.is_empty() { word.to_string() } else { format!("{word} ({})", bands.join(", ")) }
}

/// Each metric with its unit.
pub(crate) fn cells_of(metrics: &Metrics, units: Units) -> [Cell; METRICS.len()] {
    let named = metrics.named();
    std::array::from_fn(|place| match named[place].1 {
        Ok(value) => METRICS[place].cell(value, units),
        Err(NOT_SETTLED) if place == SETTLING => "not settled".into(),
        Err(_) => Cell::Missing,
    })
}

/// An error of the force below a millinewton is due to the integration, not to the loop.
fn small_as_zero(error_n: f64) -> f64 {
    if error_n.abs() < 1e-3 { 0.0 } else { error_n }
}

/// The metrics in an answer: the value of each, or the reason why there is none.
pub(crate) fn metrics_row(metrics: &Metrics) -> Object {
    let named = metrics.named().into_iter().enumerate();
    named.fold(Object::new(), |row, (place, (name, measured))| {
        let band = (place == SETTLING).then_some(metrics.settling_band_percent);
        row.told(name, measured).maybe("settling_band_percent", band)
    })
}
