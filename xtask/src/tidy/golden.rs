//! Golden numbers have an origin.
//!
//! A test, and a function, constant or static in a `tests` folder, has a comment `ORIGIN: ...`,
//! inside or directly above, if an assertion in it has a number of four significant digits or more;
//! in files called `golden*.rs`, if any number in it has that many digits.

use super::Violation;
use crate::repository::Repository;
use crate::rust_file::{Line, RustFile, numbers};

/// First words of an origin.
const ORIGINS: [&str; 8] =
    ["analytic", "thesis", "recomputed", "paper", "data sheet", "measured", "other tool", "written by hand"];

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let mut found = Vec::new();
    for file in repository.rust_files.iter().filter(|file| !file.path.starts_with("xtask/")) {
        found.extend(check_file(file));
        for line in &file.lines {
            let origin = line.text.split_once("ORIGIN:").map(|(_, origin)| origin.trim());
            let problem = origin.and_then(|origin| problem(repository, origin));
            found.extend(problem.map(|message| Violation::new(&file.path, line.number, message)));
        }
    }
    found
}

/// Problem of an origin.
fn problem(repository: &Repository, origin: &str) -> Option<String> {
    if !ORIGINS.iter().any(|known| origin.starts_with(known)) && !cites_a_year(origin) {
        return Some(format!("an origin cites (year), or starts with one of: {}", ORIGINS.join(", ")));
    }
    let script = origin.split_once("recomputed by ")?.1;
    let end = script.find(|c: char| !(c.is_alphanumeric() || "_./-".contains(c))).unwrap_or(script.len());
    let script = script[..end].trim_end_matches('.');
    (!repository.exists(script)).then(|| format!("the origin `{script}` does not exist"))
}

/// Returns true if a work is cited as in "Ledezma (2019)".
fn cites_a_year(origin: &str) -> bool {
    let inside = origin.split('(').skip(1).filter_map(|rest| rest.split(')').next());
    inside.into_iter().any(|year| year.len() == 4 && year.parse::<u16>().is_ok())
}

fn check_file(file: &RustFile) -> Vec<Violation> {
    let mut found = Vec::new();
    let mut start = 0;
    while start < file.lines.len() {
        let line = &file.lines[start];
        if !is_item(&line.code) || !(line.is_test || file.is_test_file()) {
            start += 1;
            continue;
        }
        let end = file.end_of_item(start);
        // comments and attributes
        let is_above = |line: &&Line| ["//", "#["].iter().any(|mark| line.text.trim().starts_with(mark));
        let above = file.lines[..start].iter().rev().take_while(is_above);
        let has_origin = above.chain(&file.lines[start..=end]).any(|line| line.text.contains("ORIGIN:"));
        if !has_origin && has_golden_number(file, start, end) {
            found.push(Violation::new(&file.path, line.number, "golden numbers without an ORIGIN"));
        }
        start = end + 1;
    }
    found
}

fn is_item(code: &str) -> bool {
    let words = code.trim().trim_start_matches("pub(super) ").trim_start_matches("pub(crate) ");
    let words = words.trim_start_matches("pub ");
    ["fn ", "const ", "static "].iter().any(|keyword| words.starts_with(keyword))
}

/// Returns true if these lines, or assertions among them, have a number of four digits or more.
fn has_golden_number(file: &RustFile, start: usize, end: usize) -> bool {
    let anywhere = file.path.contains("/golden");
    let mut asserted = start;
    (start..=end).any(|index| {
        let code = &file.lines[index].code;
        let assertion = code.find("assert");
        if assertion.is_some() {
            asserted = file.end_of_item(index) + 1;
        }
        let from = if anywhere || (assertion.is_none() && index < asserted) { Some(0) } else { assertion };
        from.is_some_and(|from| numbers(&code[from..]).any(|number| significant_digits(number) >= 4))
    })
}

/// Significant digits of a floating-point literal; trailing zeros of a whole number do not count.
fn significant_digits(literal: &str) -> usize {
    let mantissa = literal.split(char::is_alphabetic).next().unwrap_or_default();
    if !mantissa.contains('.') && !literal[mantissa.len()..].starts_with('e') {
        return 0;
    }
    let digits: String = mantissa.chars().filter(char::is_ascii_digit).collect();
    let digits = digits.trim_start_matches('0');
    if mantissa.ends_with(".0") { digits.trim_end_matches('0').len() } else { digits.len() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_counted() {
        let literals = ["2.233e6", "2.233e", "0.00025", "1000.0", "12.70", "1e", "2233000"];
        assert_eq!(literals.map(significant_digits), [4, 4, 2, 1, 4, 1, 0]);
    }
}
