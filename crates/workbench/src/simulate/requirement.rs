//! Required steps and the values that a step reaches, in words.

use phea_engineering::simulate::{NO_OVERSHOOT_PERCENT, ReachedStep, StepLimits};

use super::metrics::STATED;
use crate::document::Cell;
use crate::quantity::DisplayUnit;

/// The required overshoot.
pub(crate) fn required_overshoot(required: &StepLimits) -> Option<String> {
    overshoot(required).map(|cell| cell.text())
}

fn overshoot(required: &StepLimits) -> Option<Cell> {
    let most = required.overshoot_percent?;
    let most_cell = Cell::short(most, STATED, DisplayUnit::IN_PERCENT);
    Some(if most == 0.0 { "no overshoot".into() } else { most_cell.between("at most ", " overshoot") })
}

/// The required settling time.
pub(crate) fn required_settling(required: &StepLimits) -> Option<String> {
    settling(required).map(|cell| cell.text())
}

fn settling(required: &StepLimits) -> Option<Cell> {
    let time = Cell::short(required.settling_time_s?, STATED, DisplayUnit::SECOND);
    let band = Cell::short(required.band_percent, STATED, DisplayUnit::IN_PERCENT);
    Some(band.between("settled within ", " in ").then(time))
}

/// The required rise time.
pub(crate) fn required_rise(required: &StepLimits) -> Option<String> {
    rise(required).map(|cell| cell.text())
}

fn rise(required: &StepLimits) -> Option<Cell> {
    let time = Cell::short(required.rise_time_s?, STATED, DisplayUnit::SECOND);
    Some(Cell::from("risen from ").then(Cell::unit("10 to 90 %")).then(" in ").then(time))
}

/// The requirements on a step.
pub(crate) fn required_words(required: &StepLimits) -> String {
    required_cell(required).text()
}

/// The requirements on a step in a cell.
pub(crate) fn required_cell(required: &StepLimits) -> Cell {
    Cell::listed([overshoot(required), settling(required), rise(required)].into_iter().flatten(), ", ")
}

/// Values that a step reaches, for the required quantities.
pub(crate) fn reached_words(required: &StepLimits, reached: &ReachedStep) -> String {
    reached_cell(required, reached).text()
}

/// Values that a step reaches in a cell.
pub(crate) fn reached_cell(required: &StepLimits, reached: &ReachedStep) -> Cell {
    if reached.overshoot_percent == f64::INFINITY {
        return "stopped before the end of the run".into();
    }
    let in_time = |time_s: f64, did: &str, never: &str| match time_s {
        f64::INFINITY => never.into(),
        time_s => Cell::from(format!("{did} in ")).then(Cell::quantity(time_s, 3, DisplayUnit::SECOND)),
    };
    let overshoot = match reached.overshoot_percent {
        percent if percent < NO_OVERSHOOT_PERCENT => "no overshoot".into(),
        percent => Cell::quantity(percent, 3, DisplayUnit::IN_PERCENT).then(" overshoot"),
    };
    let each = [
        required.overshoot_percent.map(|_| overshoot),
        required.settling_time_s.map(|_| in_time(reached.settling_time_s, "settled", "not settled")),
        required.rise_time_s.map(|_| in_time(reached.rise_time_s, "risen", "not risen to 90 %")),
    ];
    Cell::listed(each.into_iter().flatten(), ", ")
}
