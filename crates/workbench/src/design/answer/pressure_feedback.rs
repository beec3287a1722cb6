//! The pressure feedback that a design found before its loop, in JSON.

use phea_engineering::design::{MissingPlants, PressureFeedbackDesign};

use crate::answer::{Answer, Body, Object};
use crate::error::design_error_words;
use crate::quantity::{QuantityName, VOLTAGE_PER_FORCE};

/// Pressure feedback that was designed before the loop, with the gain from it.
#[derive(Answer)]
pub(super) struct PressureFeedbackAnswer {
    /// True if the design has the feedback; false if it gains too little for a second measured
    /// signal.
    used: bool,
    /// Gain from the pressure to the command.
    gain_v_per_pa: f64,
    /// Corner frequency of the high pass; null if it has none.
    high_pass_rad_per_s: Option<f64>,
    /// Corner frequency of the low pass, only if one is declared.
    #[answer(optional)]
    low_pass_rad_per_s: Option<f64>,
    /// Ratio of the largest gain of a proportional loop with the feedback to the one without.
    loop_gain_factor: f64,
    /// Largest gain of a proportional loop with the feedback.
    #[answer(key = QuantityName::moving("proportional_gain", &VOLTAGE_PER_FORCE))]
    proportional_gain: f64,
    /// Largest gain of a proportional loop without the feedback.
    #[answer(key = QuantityName::moving("proportional_gain_without", &VOLTAGE_PER_FORCE))]
    proportional_gain_without: f64,
    /// Frequency that limits a proportional loop with the feedback.
    limited_at_rad_per_s: f64,
    /// Frequency that limits a proportional loop without the feedback.
    limited_without_at_rad_per_s: f64,
    /// Least damping ratio, with the feedback, of the oscillations of the plants within a factor of
    /// two of `limited_without_at_rad_per_s`; left out if there are none.
    #[answer(optional)]
    least_damping_ratio: Option<f64>,
    /// Least damping ratio of these oscillations without the feedback; left out if there are none.
    #[answer(optional)]
    least_damping_ratio_without: Option<f64>,
    /// Number of plants for which the feedback was designed.
    plants: usize,
    /// Plants with waves in their lines for which the feedback was not designed, only if there are
    /// any.
    #[answer(optional)]
    missing_with_waves: Option<MissingPlantsAnswer>,
}

/// Plants whose responses cannot be computed.
#[derive(Answer)]
struct MissingPlantsAnswer {
    /// Number of these plants.
    count: usize,
    /// Number of all plants with waves in their lines.
    of: usize,
    /// Reason for which the first of them has no response.
    reason: String,
}

/// The feedback.
pub(super) fn feedback(found: &PressureFeedbackDesign) -> PressureFeedbackAnswer {
    let [limited_without, limited_with] = found.limited_at_rad_per_s;
    let [gain_without, gain_with] = found.proportional_gain;
    let damping = found.least_damping_ratio;
    let missing = |plants: &MissingPlants| MissingPlantsAnswer {
        count: plants.count,
        of: plants.of,
        reason: design_error_words(&plants.reason),
    };
    PressureFeedbackAnswer {
        used: found.is_used,
        gain_v_per_pa: found.declared.gain,
        high_pass_rad_per_s: found.declared.high_pass,
        low_pass_rad_per_s: found.declared.low_pass,
        loop_gain_factor: found.loop_gain_factor,
        proportional_gain: gain_with,
        proportional_gain_without: gain_without,
        limited_at_rad_per_s: limited_with,
        limited_without_at_rad_per_s: limited_without,
        least_damping_ratio: damping.map(|[_, with]| with),
        least_damping_ratio_without: damping.map(|[without, _]| without),
        plants: found.plants,
        missing_with_waves: found.missing_with_waves.as_ref().map(missing),
    }
}

/// A feedback that was found before the loop, as an object of JSON.
pub fn pressure_feedback_object(found: &PressureFeedbackDesign) -> Object {
    feedback(found).into_object()
}
