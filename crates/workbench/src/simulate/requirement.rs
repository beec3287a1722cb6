//! Required steps and the values that a step reaches, in words.

use super::{NO_OVERSHOOT_PERCENT, ReachedStep, StepLimits};
use crate::quantity::significant;

/// The required overshoot.
pub(crate) fn required_overshoot(required: &StepLimits) -> Option<String> {
    let most = required.overshoot_percent?;
    Some(if most == 0.0 { "no overshoot".to_string() } else { format!("at most {most} % overshoot") })
}

/// The required settling time.
pub(crate) fn required_settling(required: &StepLimits) -> Option<String> {
    required.settling_time_s.map(|time_s| format!("settled within {} % in {time_s} s", required.band_percent))
}

/// The required rise time.
pub(crate) fn required_rise(required: &StepLimits) -> Option<String> {
    required.rise_time_s.map(|time_s| format!("risen from 10 to 90 % in {time_s} s"))
}

/// The requirements on a step.
pub(crate) fn required_words(required: &StepLimits) -> String {
    let all = [required_overshoot(required), required_settling(required), required_rise(required)];
    all.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

/// Values that a step reaches, for the required quantities.
pub(crate) fn reached_words(required: &StepLimits, reached: &ReachedStep) -> String {
    if reached.overshoot_percent == f64::INFINITY {
        return "stopped before the end of the run".to_string();
    }
    let in_time = |time_s: f64, did: &str, never: &str| match time_s {
        f64::INFINITY => never.to_string(),
        time_s => format!("{did} in {} s", significant(time_s, 3)),
    };
    let overshoot = match reached.overshoot_percent {
        percent if percent < NO_OVERSHOOT_PERCENT => "no overshoot".to_string(),
        percent => format!("{} % overshoot", significant(percent, 3)),
    };
    let each = [
        required.overshoot_percent.map(|_| overshoot),
        required.settling_time_s.map(|_| in_time(reached.settling_time_s, "settled", "not settled")),
        required.rise_time_s.map(|_| in_time(reached.rise_time_s, "risen", "not risen to 90 %")),
    ];
    each.into_iter().flatten().collect::<Vec<_>>().join(", ")
}
