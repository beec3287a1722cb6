//! `lead through -6 dB, -130 deg at 20 rad/s`
//!
//! ```text
//! wish   = [number "="] kind ["with" key value] "through" coordinate ["," coordinate] "at" frequency
//! ```

use phea_qft::manual_shaping::{ElementPattern, WantedPoint};

use super::piece::TextPiece;
use super::words::element_words;
use crate::project::{Findings, RawFinding};
use crate::quantity::{self, ANGULAR_FREQUENCY};
use crate::spelling::nearest;

/// An element that is to be solved for.
pub(super) struct ElementWish<'a> {
    /// The number of the element that it replaces.
    pub(super) replaced: Option<TextPiece<'a>>,
    pub(super) pattern: ElementPattern,
    pub(super) point: WantedPoint,
}

const EXAMPLE: &str = "for instance: lead through -6 dB, -130 deg at 20 rad/s";
/// Damping of a notch's poles where none is given.
const NOTCH_DAMPING: f64 = 0.5;
/// Damping of a roll-off where none is given.
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

/// Reads a request; `None` where it is invalid, with the reason in the findings.
pub(super) fn read<'a>(whole: &TextPiece<'a>, findings: &mut Findings) -> Option<ElementWish<'a>> {
    let Some([head, place]) = whole.split("through") else {
        return whole.refuse(findings, "it does not say `through` which point", EXAMPLE);
    };
    let Some([point, at]) = place.split_last(" at ") else {
        return place.refuse(findings, "it does not say `at` which frequency", EXAMPLE);
    };
    let numbered =
        head.words.split_whitespace().next().is_some_and(|word| word.starts_with(char::is_numeric));
    let (replaced, head) = match head.split("=").filter(|_| numbered) {
        Some([number, rest]) => (Some(number), rest),
        None => (None, head),
    };
    let pattern = pattern(&head, findings)?;
    let [magnitude_db, phase_deg] = coordinates(&point, findings)?;
    let frequency_rad_per_s = frequency(&at, findings)?;
    Some(ElementWish {
        replaced,
        pattern,
        point: WantedPoint { frequency_rad_per_s, magnitude_db, phase_deg },
    })
}

/// The element, and its number that is given.
fn pattern(head: &TextPiece<'_>, findings: &mut Findings) -> Option<ElementPattern> {
    let [kind, given] = head.first_word();
    let Some((_, pattern)) = SOLVED.iter().find(|(name, _)| *name == kind.words) else {
        let names = SOLVED.map(|(name, _)| name);
        let expected = format!("one of {}", names.join(", "));
        let fixed = ["integrator", "differentiator"].contains(&kind.words);
        let message = if fixed {
            format!("`{}` has no number that could be solved for", kind.words)
        } else {
            format!("`{}` cannot be solved for", kind.words)
        };
        let near = nearest(kind.words, names).map(|name| format!("did you mean `{name}`?"));
        findings.push(RawFinding::error(kind.place(), message).expected(expected).maybe_help(near));
        return None;
    };
    if given.words.is_empty() {
        return Some(*pattern);
    }
    let [with, setting] = given.first_word();
    if with.words != "with" {
        return given.refuse(findings, format!("`{}` is not understood", given.words), EXAMPLE);
    }
    let [key, value] = match setting.split("=") {
        Some(parts) => parts,
        None => setting.first_word(),
    };
    numbered(*pattern, &key, &value, findings)
}

/// The pattern with a number that is given.
fn numbered(
    pattern: ElementPattern,
    key: &TextPiece<'_>,
    value: &TextPiece<'_>,
    findings: &mut Findings,
) -> Option<ElementPattern> {
    match (pattern, key.words) {
        (ElementPattern::RollOff { .. }, "damping_ratio") => {
            Some(ElementPattern::RollOff { damping_ratio: plain(value, findings)? })
        }
        (ElementPattern::NotchHere { .. }, "damping_ratio") => {
            Some(ElementPattern::NotchHere { pole_damping_ratio: plain(value, findings)? })
        }
        (ElementPattern::NotchHere { .. }, "frequency") => {
            Some(ElementPattern::NotchBeside { natural_frequency: frequency(value, findings)? })
        }
        _ => {
            let message = format!("`{}` cannot be given for {}", key.words, element_words(pattern));
            let help = "a notch takes `frequency` or `damping_ratio`, a roll_off `damping_ratio`";
            key.refuse(findings, message, help)
        }
    }
}

/// Magnitude in dB and phase in degrees, whichever are given.
fn coordinates(point: &TextPiece<'_>, findings: &mut Findings) -> Option<[Option<f64>; 2]> {
    let parts = point.split(",").map_or_else(|| vec![*point], |parts| parts.to_vec());
    let mut found = [None, None];
    for part in parts {
        let (index, value) = match (part.before("dB"), part.before("deg").or(part.before("°"))) {
            (Some(number), _) => (0, plain(&number, findings)?),
            (None, Some(number)) => (1, plain(&number, findings)?),
            (None, None) => {
                let message = format!("`{}` is not a coordinate of the chart", part.words);
                return part.refuse(findings, message, "write a magnitude in dB, a phase in deg, or both");
            }
        };
        match found.get_mut(index) {
            Some(slot @ None) => *slot = Some(value),
            _ => return part.refuse(findings, "this coordinate is given twice", EXAMPLE),
        }
    }
    Some(found)
}

fn plain(piece: &TextPiece<'_>, findings: &mut Findings) -> Option<f64> {
    match piece.words.parse::<f64>() {
        Ok(value) if value.is_finite() => Some(value),
        _ => piece.refuse(findings, format!("`{}` is not a number", piece.words), EXAMPLE),
    }
}

/// rad/s where no unit is given.
fn frequency(piece: &TextPiece<'_>, findings: &mut Findings) -> Option<f64> {
    if let Some(value) = piece.words.parse::<f64>().ok().filter(|value| value.is_finite()) {
        return Some(value);
    }
    match quantity::parse(piece.words, &ANGULAR_FREQUENCY) {
        Ok(value) => Some(value),
        Err(error) => {
            let place = piece.place_of(&error.range);
            let found = RawFinding::error(place, error.fault.to_string());
            let found = found.maybe_expected(error.expected.map(|expected| expected.to_string()));
            findings.push(found.maybe_help(error.help.map(|help| help.to_string())));
            None
        }
    }
}
