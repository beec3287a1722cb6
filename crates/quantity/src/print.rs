//! Output of a quantity in the customary unit, without losing a bit.

use super::dimension::Dimension;
use super::display_unit::DisplayUnit;
use super::parse::parse;
use super::shortest::{plain, rounded};

/// Shortest TOML text that reads back as exactly `value`: `"70 bar"` with its quotes if an
/// engineering unit can express it, otherwise a bare SI number.
///
/// # Example
/// ```
/// use phea_quantity::{FLOW_GAIN, LENGTH, PRESSURE, print};
/// assert_eq!(print(7e6, &PRESSURE), "\"70 bar\"");
/// assert_eq!(print(0.0127, &LENGTH), "\"12.7 mm\"");
/// assert_eq!(print(5.62e-5, &FLOW_GAIN), "5.62e-5");
/// ```
pub fn print(value: f64, dimension: &Dimension) -> String {
    if !value.is_finite() {
        return print_bare(value);
    }
    let Some(unit) = fitting_unit(value, dimension) else { return print_bare(value) };
    match exactly(value, unit, dimension) {
        Some(number) => format!("\"{number} {unit}\""),
        None => print_bare(value),
    }
}

/// Text for readers: `value` rounded to this number of significant digits, in the customary unit,
/// without quotes.
///
/// # Example
/// ```
/// use phea_quantity::{PRESSURE, RATIO, display};
/// assert_eq!(display(63_630_123.0, &PRESSURE, 4), "636.3 bar");
/// assert_eq!(display(0.9, &RATIO, 4), "0.9");
/// ```
pub fn display(value: f64, dimension: &Dimension, significant_digits: usize) -> String {
    let digits = significant_digits.clamp(1, 17);
    let unit = fitting_unit(value, dimension);
    let scaled = value / unit.map_or(1.0, |unit| factor(unit, dimension));
    let number = plain(rounded(scaled, digits));
    match unit {
        Some(unit) if value.is_finite() => format!("{number} {unit}"),
        _ if value.is_finite() && dimension.si != "1" => format!("{number} {}", dimension.si),
        _ => number,
    }
}

/// Customary unit for such a value, for several numbers in one unit.
///
/// # Example
/// ```
/// use phea_quantity::{LENGTH, fitting};
/// let unit = fitting(0.25, &LENGTH);
/// assert_eq!((unit.symbol, unit.number(0.005, 2)), ("mm", "5.0".to_string()));
/// ```
pub fn fitting(value: f64, dimension: &Dimension) -> DisplayUnit {
    match fitting_unit(value, dimension) {
        Some(symbol) => DisplayUnit { symbol, in_si: factor(symbol, dimension) },
        None => DisplayUnit { symbol: dimension.si, in_si: 1.0 },
    }
}

/// Number in the syntax of TOML.
pub fn print_bare(value: f64) -> String {
    let text =
        if value.abs() >= 1e-4 && value.abs() < 1e15 { format!("{value}") } else { format!("{value:e}") };
    if value.is_nan() { "nan".to_string() } else { text }
}

/// Largest of the dimension's units that is not above the value, or the smallest; for zero the SI
/// unit, if it is one of them.
fn fitting_unit(value: f64, dimension: &Dimension) -> Option<&'static str> {
    let fits = |unit: &&&str| factor(unit, dimension) <= value.abs() * (1.0 + 1e-12);
    if value == 0.0 && dimension.units.contains(&dimension.si) {
        return Some(dimension.si);
    }
    dimension.units.iter().rev().find(fits).or(dimension.units.first()).copied()
}

fn factor(unit: &str, dimension: &Dimension) -> f64 {
    parse(&format!("1 {unit}"), dimension).unwrap_or(1.0)
}

/// Shortest number that is exactly `value` in that unit.
fn exactly(value: f64, unit: &str, dimension: &Dimension) -> Option<String> {
    let scaled = value / factor(unit, dimension);
    let neighbours = [scaled, scaled.next_up(), scaled.next_down()];
    for digits in 1..=17 {
        for neighbour in neighbours {
            let number = plain(rounded(neighbour, digits));
            if parse(&format!("{number} {unit}"), dimension) == Ok(value) {
                return Some(number);
            }
        }
    }
    None
}
