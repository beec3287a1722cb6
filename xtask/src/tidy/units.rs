//! SI inside: the factor between another unit and SI is in `crates/quantity` and nowhere else.

use super::Violation;
use crate::repository::Repository;
use crate::rust_file::numbers;

/// The folder in which text is parsed and printed.
const HOME: &str = "crates/quantity/src";

/// The digits of factors that no other number is likely to have, and the units that they convert.
const FACTORS: [(f64, &str); 7] = [
    (6.894_757_293, "psi"),
    (4.448_221_615, "pounds of force"),
    (3.785_411_784, "US gallons"),
    (6.309_019_64, "US gallons a minute"),
    (3.048, "feet"),
    (1.745_329_252, "degrees"),
    (5.729_577_951, "degrees"),
];

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let mut found = Vec::new();
    let elsewhere = repository.rust_files.iter().filter(|file| !file.path.starts_with(HOME));
    for file in elsewhere.filter(|file| file.is_shipped()) {
        let numbers =
            file.shipped().flat_map(|line| numbers(&line.code).map(move |number| (line.number, number)));
        for (line, number) in numbers {
            let units = FACTORS.iter().filter(|(factor, _)| has_digits_of(number, *factor));
            let message = |unit| format!("{number} converts {unit}: conversions belong to {HOME}");
            found.extend(units.map(|(_, unit)| Violation::new(&file.path, line, message(unit))));
        }
    }
    found
}

/// Returns true if the two numbers agree in their first five digits, regardless of the decimal
/// point.
fn has_digits_of(literal: &str, factor: f64) -> bool {
    let plain = literal.split(char::is_alphabetic).next().unwrap_or_default().replace('_', "");
    let number: f64 = plain.parse().unwrap_or_default();
    let scientific = format!("{number:e}");
    let mantissa = scientific.split('e').next().and_then(|digits| digits.parse::<f64>().ok());
    mantissa.is_some_and(|mantissa| (mantissa / factor - 1.0).abs() < 1e-5)
}
