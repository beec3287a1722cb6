//! Parser of requests for an element, such as `lead through -6 dB, -130 deg at 20 rad/s`.
//!
//! ```text
//! wish   = [number "="] kind ["with" key value] "through" coordinate ["," coordinate] "at" frequency
//! ```

use phea_qft::manual_shaping::{ElementPattern, WantedPoint};

use super::piece::TextPiece;
use super::refused::{ChangeProblem, RefusedChange};
use crate::quantity::{self, ANGULAR_FREQUENCY};

/// An element that is to be solved for.
pub(super) struct ElementRequest<'a> {
    /// Number of the element that it replaces.
    pub(super) replaced: Option<TextPiece<'a>>,
    pub(super) pattern: ElementPattern,
    pub(super) point: WantedPoint,
}

/// Damping of a notch's poles if none is given.
const NOTCH_DAMPING: f64 = 0.5;
/// Damping of a roll-off if none is given.
const ROLL_OFF_DAMPING: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Elements with free numbers.
const SOLVED: [(&str, ElementPattern); 10] = [
    ("gain", ElementPattern::Gain),
    ("pole", ElementPattern::RealPole),
    ("zero", ElementPattern::RealZero),
    ("lead", ElementPattern::Lead),
    ("lag", ElementPattern::Lag),
    ("complex_poles", ElementPattern::ComplexPoles),
    ("complex_zeros", ElementPattern::ComplexZeros),
    ("roll_off", ElementPattern::RollOff { damping_ratio: ROLL_OFF_DAMPING }),
    ("pi", ElementPattern::ProportionalIntegral),
    ("notch", ElementPattern::NotchHere { pole_damping_ratio: NOTCH_DAMPING }),
];

/// Kinds of elements that are solved for.
pub fn solved_kinds() -> [&'static str; 10] {
    SOLVED.map(|(name, _)| name)
}

/// Parses a request.
pub(super) fn read<'a>(whole: &TextPiece<'a>) -> Result<ElementRequest<'a>, Box<RefusedChange>> {
    let [head, place] = whole.split("through").ok_or_else(|| whole.refused(ChangeProblem::NoPoint))?;
    let [point, at] = place.split_last(" at ").ok_or_else(|| place.refused(ChangeProblem::NoFrequency))?;
    let numbered =
        head.words.split_whitespace().next().is_some_and(|word| word.starts_with(char::is_numeric));
    let (replaced, head) = match head.split("=").filter(|_| numbered) {
        Some([number, rest]) => (Some(number), rest),
        None => (None, head),
    };
    let pattern = pattern(&head)?;
    let [magnitude_db, phase_deg] = coordinates(&point)?;
    let frequency_rad_per_s = frequency(&at)?;
    Ok(ElementRequest {
        replaced,
        pattern,
        point: WantedPoint { frequency_rad_per_s, magnitude_db, phase_deg },
    })
}

/// Kind of the element, with its given number.
fn pattern(head: &TextPiece<'_>) -> Result<ElementPattern, Box<RefusedChange>> {
    let [kind, given] = head.first_word();
    let Some((_, pattern)) = SOLVED.iter().find(|(name, _)| *name == kind.words) else {
        let fixed = ["integrator", "differentiator"].contains(&kind.words);
        let reason = if fixed { ChangeProblem::WithoutNumber } else { ChangeProblem::NotSolved };
        return Err(kind.refused(reason(kind.words.to_string())));
    };
    if given.words.is_empty() {
        return Ok(*pattern);
    }
    let [with, setting] = given.first_word();
    if with.words != "with" {
        return Err(given.refused(ChangeProblem::NotUnderstood(given.words.to_string())));
    }
    let [key, value] = match setting.split("=") {
        Some(parts) => parts,
        None => setting.first_word(),
    };
    numbered(*pattern, &key, &value)
}

/// The pattern with a given number.
fn numbered(
    pattern: ElementPattern,
    key: &TextPiece<'_>,
    value: &TextPiece<'_>,
) -> Result<ElementPattern, Box<RefusedChange>> {
    match (pattern, key.words) {
        (ElementPattern::RollOff { .. }, "damping_ratio") => {
            Ok(ElementPattern::RollOff { damping_ratio: plain(value)? })
        }
        (ElementPattern::NotchHere { .. }, "damping_ratio") => {
            Ok(ElementPattern::NotchHere { pole_damping_ratio: plain(value)? })
        }
        (ElementPattern::NotchHere { .. }, "frequency") => {
            Ok(ElementPattern::FurtherNotch { natural_frequency: frequency(value)? })
        }
        _ => Err(key.refused(ChangeProblem::NotGiven { key: key.words.to_string(), pattern })),
    }
}

/// Magnitude, dB, and phase, degrees; `None` if not given.
fn coordinates(point: &TextPiece<'_>) -> Result<[Option<f64>; 2], Box<RefusedChange>> {
    let parts = point.split(",").map_or_else(|| vec![*point], |parts| parts.to_vec());
    let mut found = [None, None];
    for part in parts {
        let (index, value) = match (part.before("dB"), part.before("deg").or(part.before("°"))) {
            (Some(number), _) => (0, plain(&number)?),
            (None, Some(number)) => (1, plain(&number)?),
            (None, None) => {
                return Err(part.refused(ChangeProblem::NotACoordinate(part.words.to_string())));
            }
        };
        match found.get_mut(index) {
            Some(slot @ None) => *slot = Some(value),
            _ => return Err(part.refused(ChangeProblem::CoordinateGivenTwice)),
        }
    }
    Ok(found)
}

fn plain(piece: &TextPiece<'_>) -> Result<f64, Box<RefusedChange>> {
    match piece.words.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(piece.refused(ChangeProblem::NotANumber(piece.words.to_string()))),
    }
}

/// Frequency, in rad/s if no unit is given.
fn frequency(piece: &TextPiece<'_>) -> Result<f64, Box<RefusedChange>> {
    if let Some(value) = piece.words.parse::<f64>().ok().filter(|value| value.is_finite()) {
        return Ok(value);
    }
    quantity::parse(piece.words, &ANGULAR_FREQUENCY)
        .map_err(|error| piece.refused_at(&error.range.clone(), ChangeProblem::Frequency(error)))
}
