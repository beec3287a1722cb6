//! Reason why no element passes the requested point, in words.

use phea_dynamics::portable;
use phea_qft::manual_shaping::{ElementPattern, NeededCoordinate, PassError, Reach};

/// The name of an element, with an article.
pub(super) fn element_words(pattern: ElementPattern) -> &'static str {
    match pattern {
        ElementPattern::Gain => "a gain",
        ElementPattern::RealPole => "a real pole",
        ElementPattern::RealZero => "a real zero",
        ElementPattern::Lead => "a lead",
        ElementPattern::Lag => "a lag",
        ElementPattern::ComplexPoles => "a complex pair of poles",
        ElementPattern::ComplexZeros => "a complex pair of zeros",
        ElementPattern::RollOff { .. } => "a roll-off",
        ElementPattern::ProportionalIntegral => "a PI element",
        ElementPattern::NotchHere { .. } => "a notch at this frequency",
        ElementPattern::FurtherNotch { .. } => "a notch next to this frequency",
    }
}

/// Reason why no element is found.
pub fn pass_words(error: &PassError) -> String {
    match error {
        PassError::Frequency { frequency_rad_per_s } => {
            format!("the loop has no point at {frequency_rad_per_s} rad/s")
        }
        PassError::NoLoop { present, frequency_rad_per_s } => {
            format!("the loop is {present} at {frequency_rad_per_s} rad/s: no element moves it")
        }
        PassError::Incomplete { pattern, needs } => {
            let needs = match needs {
                NeededCoordinate::Magnitude => "the magnitude",
                NeededCoordinate::Either => "magnitude or phase",
                NeededCoordinate::Both => "magnitude and phase",
            };
            format!("{} needs {needs} of the point", element_words(*pattern))
        }
        PassError::Number { pattern, value } => {
            let what = match pattern {
                ElementPattern::FurtherNotch { .. } => "frequency",
                _ => "damping ratio",
            };
            format!("{} cannot have a {what} of {value}", element_words(*pattern))
        }
        PassError::Discretization => {
            "in a sampled loop an element is solved for with the discretization `tustin` alone".to_string()
        }
        PassError::Unreachable { pattern, turn_deg, raise_db, reach } => {
            unreachable_words(element_words(*pattern), *turn_deg, *raise_db, reach)
        }
    }
}

fn unreachable_words(name: &str, turn_deg: Option<f64>, raise_db: Option<f64>, reach: &Reach) -> String {
    if let (Some(turn), None) = (turn_deg, reach.raise_db) {
        let [low, high] = reach.turn_deg;
        let can = if low == high {
            "leaves the phase as it is".to_string()
        } else {
            format!("turns the loop by more than {low} and less than {high} degrees")
        };
        return format!("{name} {can}; the point needs {} degrees", signed(turn));
    }
    let range = match reach.raise_db {
        Some([low, high]) if low == high => format!("by {} dB", signed(low)),
        Some([low, high]) if low == f64::NEG_INFINITY => format!("by less than {} dB", signed(high)),
        Some([low, f64::INFINITY]) => format!("by more than {} dB", signed(low)),
        Some([low, high]) => format!("by more than {} and less than {} dB", signed(low), signed(high)),
        None => "by nothing".to_string(),
    };
    let there = turn_deg.map_or(String::new(), |turn| format!(", turning it by {} degrees,", signed(turn)));
    let needs = raise_db
        .map_or("rounding leaves none".to_string(), |raise| format!("the point needs {} dB", signed(raise)));
    format!("{name}{there} raises the loop {range}; {needs}")
}

fn signed(value: f64) -> String {
    let rounded = portable::rounded(value, 4);
    if value > 0.0 { format!("+{rounded}") } else { rounded.to_string() }
}
