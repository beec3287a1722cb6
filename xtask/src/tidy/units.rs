//! SI inside: the factor between another unit and SI stands in `crates/quantity` and nowhere else.

use super::Violation;
use crate::repository::{Repository, RustFile};

/// Where text is parsed and printed.
const HOME: &str = "crates/quantity/src";

/// The digits of factors that no other number is likely to have, and what they convert.
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
    let library_or_shell =
        |file: &&RustFile| file.path.starts_with("crates/") || file.path.starts_with("apps/");
    let elsewhere = repository.rust_files().iter().filter(library_or_shell);
    elsewhere
        .filter(|file| !file.path.starts_with(HOME) && !file.is_test_file())
        .flat_map(check_file)
        .collect()
}

fn check_file(file: &RustFile) -> Vec<Violation> {
    let mut found = Vec::new();
    for (number, line) in file.shipped().numbers {
        for (_, unit) in FACTORS.iter().filter(|(factor, _)| has_digits_of(number, *factor)) {
            let message = format!("{number} converts {unit}: conversions belong to {HOME}");
            found.push(Violation::new(&file.path, line, message));
        }
    }
    found
}

/// Whether the two numbers agree in their first five digits, wherever the decimal point is.
fn has_digits_of(number: f64, factor: f64) -> bool {
    number > 0.0 && (mantissa(number) / mantissa(factor) - 1.0).abs() < 1e-5
}

/// The number with its decimal point moved behind the first digit.
fn mantissa(number: f64) -> f64 {
    let text = format!("{number:e}");
    text.split('e').next().and_then(|digits| digits.parse().ok()).unwrap_or(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(path: &str, text: &str) -> usize {
        check(&Repository::from_texts(&[(path, text)])).len()
    }

    #[test]
    fn factors_are_found_wherever_the_decimal_point_is() {
        for text in ["6894.757293168", "6.8948e3", "0.3048", "4.4482216", "57.29577951308232", "6.30902e-5"] {
            assert_eq!(
                count("crates/hydraulics/src/line.rs", &format!("const A: f64 = {text};")),
                1,
                "{text}"
            );
        }
        assert_eq!(count("apps/cli/src/main.rs", "fn f() { print(x * 3.785411784e-3) }"), 1);
    }

    #[test]
    fn home_tests_and_other_numbers_are_left_alone() {
        assert_eq!(count("crates/quantity/src/unit.rs", "const A: f64 = 6894.757293168;"), 0);
        assert_eq!(count("crates/qft/src/lib.rs", "#[cfg(test)] mod tests { const A: f64 = 0.3048; }"), 0);
        assert_eq!(count("crates/qft/src/lib.rs", "const A: [f64; 4] = [0.3, 6.9, 3.785, 0.0];"), 0);
    }
}
