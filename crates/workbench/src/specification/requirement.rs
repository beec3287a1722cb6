//! A requirement in time and the values that its limit reaches, in a sentence.

use phea_dynamics::time_response::Settling;
use phea_qft::specification::{RequiredResponse, RequirementCheck, RequirementOutcome};

use super::CheckedRequirement;
use crate::quantity::{RATIO, display};

/// The requirement, the verdict on its limit, and the values that the limit itself reaches.
pub fn requirement_sentence(requirement: &CheckedRequirement) -> String {
    let met = if requirement.is_met() { "met" } else { "not met" };
    let words = words(&requirement.check);
    format!("Specification {}, {} limit, {met}; {words}.", requirement.number, requirement.key)
}

/// Words such as `required: at most 1 % overshoot, settled within 1 % in 0.1 s; the limit itself
/// reaches 2.19 % overshoot and settles in 0.126 s`.
fn words(check: &RequirementCheck) -> String {
    let RequiredResponse { overshoot_percent, settling_time_s, settling_band_percent } = check.required;
    let required = match overshoot_percent {
        0.0 => "no overshoot".to_string(),
        _ => format!("at most {overshoot_percent} % overshoot"),
    };
    let reached = if check.outcome() == RequirementOutcome::Met {
        "satisfies it".to_string()
    } else {
        let overshoot = match check.reached.overshoot_percent {
            0.0 => "has no overshoot".to_string(),
            reached => format!("reaches {} % overshoot", distinguishing_digits(reached, overshoot_percent)),
        };
        let settling = match check.reached.settling {
            Settling::Settled { time_s } => {
                format!("settles in {} s", distinguishing_digits(time_s, settling_time_s))
            }
            Settling::NotSettled { deviation_percent } => {
                format!("stays {} % off", display(deviation_percent, &RATIO, 3))
            }
        };
        format!("{overshoot} and {settling}")
    };
    format!(
        "required: {required}, settled within {settling_band_percent} % in {settling_time_s} s; the limit itself {reached}"
    )
}

/// The value in three digits, or in as many more as distinguish it from the other.
fn distinguishing_digits(value: f64, other: f64) -> String {
    let number = |value: f64, digits: usize| display(value, &RATIO, digits);
    let differs = |digits: &usize| value == other || number(value, *digits) != number(other, *digits);
    number(value, (3..12).find(differs).unwrap_or(12))
}
