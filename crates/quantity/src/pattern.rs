//! Quantities as regular expressions, for schemas with which editors check a file while it is
//! edited.

use super::dimension::{Dimension, Exponents, GAIN, LENGTH};
use super::parse::accepts;
use super::unit::{self, Unit};

/// Decimal number, as [`parse`](super::parse()) reads it.
const NUMBER: &str = r"[+-]?(?:[0-9]+(?:\.[0-9]+)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?";
/// Decimal number without a sign.
pub(crate) const UNSIGNED: &str = r"(?:[0-9]+(?:\.[0-9]+)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?";
/// Exponent of any size.
const EXPONENT: &str = r"(?:\^?-?[0-9]*\.?[0-9]+|[²³])?";

/// Matches every text that [`parse`](super::parse()) accepts for this dimension and whose unit is
/// one name with an exponent, or absent. A unit of another dimension is not matched.
///
/// The syntax is common to ECMA-262, Python and the crate `regex`.
///
/// # Example
/// ```
/// use phea_quantity::{TIME, single_unit_pattern};
/// assert!(single_unit_pattern(&TIME).contains("min"));
/// assert!(!single_unit_pattern(&TIME).contains("psi"));
/// ```
pub fn single_unit_pattern(dimension: &Dimension) -> String {
    let mut units: Vec<String> = unit::all().filter_map(|unit| power_of(unit, dimension)).collect();
    if std::ptr::eq(dimension, &GAIN) {
        units.push("dB".to_string());
    }
    let needed = if dimension.exponents == Exponents::NONE { "?" } else { "" };
    format!(r"^\s*{NUMBER}\s*(?:{}){needed}\s*$", units.join("|"))
}

/// Matches every number with a product of units, written together or not, or with a unit in
/// parentheses, of any dimension.
pub fn compound_unit_pattern() -> String {
    let prefixes: String = unit::prefixes().collect();
    let [beginnings, others] = [unit::BEGINNINGS.join("|"), unit::CONTINUATIONS.join("|")];
    let together = format!("[{prefixes}]?(?:{beginnings})(?:{others})+");
    let names: Vec<String> = unit::all().map(names).chain([together.clone()]).collect();
    let named = format!("(?:(?:{}){EXPONENT}|1)", names.join("|"));
    let (times, over) = (r"(?:\s*[.*·]\s*|\s+)", r"\s*/\s*");
    let group = format!(r"\(\s*{named}(?:{times}{named})*(?:{over}{named})*\s*\){EXPONENT}");
    let factor = format!("(?:{named}|{group})");
    let products = [
        format!("{factor}(?:{times}{factor})+(?:{over}{factor})*"),
        format!("{factor}(?:{over}{factor})+"),
        format!("{together}{EXPONENT}"),
        group,
    ];
    format!(r"^\s*{NUMBER}\s*(?:{})\s*$", products.join("|"))
}

/// Matches every text that begins with a number, and infinity.
pub fn any_quantity_pattern() -> String {
    format!(r"^\s*(?:{NUMBER}|[+-]?inf\s*$)")
}

/// All units of a length.
pub(crate) fn length_units() -> String {
    let units: Vec<String> = unit::all().filter_map(|unit| power_of(unit, &LENGTH)).collect();
    units.join("|")
}

/// Names of a unit with the exponent that gives the dimension; `None` if no exponent does.
fn power_of(unit: &Unit, dimension: &Dimension) -> Option<String> {
    if unit.exponents == Exponents::NONE {
        let free = format!("{}{EXPONENT}", names(unit));
        return (dimension.exponents == Exponents::NONE).then_some(free);
    }
    let halves = (-16..=16_i8).filter(|halves| *halves != 0);
    let powers: Vec<String> = halves
        .filter(|halves| unit.exponents.to_halves(*halves).is_some_and(|found| accepts(dimension, found)))
        .map(exponent)
        .collect();
    let [first, others @ ..] = powers.as_slice() else { return None };
    let exponents = others.iter().fold(first.clone(), |all, one| format!("{all}|{one}"));
    Some(format!("{}(?:{exponents})", names(unit)))
}

/// Exponent of this number of halves; 1 may be omitted.
fn exponent(halves: i8) -> String {
    let sign = if halves < 0 { "-" } else { "" };
    let (whole, half) = (halves.unsigned_abs() / 2, halves % 2 != 0);
    match (halves, whole) {
        (2, _) => r"(?:\^?0*1(?:\.0*)?)?".to_string(),
        (4, _) => r"\^?0*2(?:\.0*)?|²".to_string(),
        (6, _) => r"\^?0*3(?:\.0*)?|³".to_string(),
        (_, 0) => format!(r"\^?{sign}0*\.50*"),
        _ if half => format!(r"\^?{sign}0*{whole}\.50*"),
        _ => format!(r"\^?{sign}0*{whole}(?:\.0*)?"),
    }
}

/// All spellings of a unit.
fn names(unit: &Unit) -> String {
    let prefixes: String = if unit.prefixes { unit::prefixes().collect() } else { String::new() };
    let optional = if unit.prefixes { format!("[{prefixes}]?") } else { String::new() };
    match unit.names {
        [only] => format!("{optional}{only}"),
        several => format!("{optional}(?:{})", several.join("|")),
    }
}
