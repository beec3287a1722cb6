//! A golden number names its origin.
//!
//! A test, and a function, constant or static in a `tests` folder, carries a comment `ORIGIN: ...`,
//! inside or directly above, if an assertion in it names a number of four significant digits or
//! more; in files called `golden*.rs`, if any number in it has that many digits.

use proc_macro2::{Span, TokenStream, TokenTree};
use syn::spanned::Spanned;

use super::Violation;
use crate::ci::recomputed_by;
use crate::repository::{Repository, RustFile, is_test_item};

/// What an origin starts with.
const ORIGINS: [&str; 8] =
    ["analytic", "thesis", "recomputed", "paper", "data sheet", "measured", "other tool", "written by hand"];

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let mut found = Vec::new();
    for file in repository.rust_files().iter().filter(|file| !file.path.starts_with("xtask/")) {
        found.extend(check_file(file));
        for (index, line) in file.text.lines().enumerate() {
            let problem =
                line.split_once("ORIGIN:").and_then(|(_, origin)| check_origin(repository, line, origin));
            found.extend(problem.map(|message| Violation::new(&file.path, index + 1, message)));
        }
    }
    found
}

fn check_origin(repository: &Repository, line: &str, origin: &str) -> Option<String> {
    let origin = origin.trim();
    match recomputed_by(line) {
        _ if !ORIGINS.iter().any(|known| origin.starts_with(known)) && !cites_a_year(origin) => {
            Some(format!("an origin cites (year), or starts with one of: {}", ORIGINS.join(", ")))
        }
        Some(script) if !repository.exists(script) => Some(format!("the origin `{script}` does not exist")),
        _ => None,
    }
}

/// Whether a work is cited as in "Ledezma (2019)".
fn cites_a_year(origin: &str) -> bool {
    let inside = origin.split('(').skip(1).filter_map(|rest| rest.split(')').next());
    inside.into_iter().any(|year| year.len() == 4 && year.parse::<u16>().is_ok())
}

fn check_file(file: &RustFile) -> Vec<Violation> {
    let mut found = Vec::new();
    let mut items: Vec<&syn::Item> = file.syntax.items.iter().collect();
    while let Some(item) = items.pop() {
        if let syn::Item::Mod(syn::ItemMod { content: Some((_, inner)), .. }) = item {
            items.extend(inner);
            continue;
        }
        let is_test = matches!(item, syn::Item::Fn(function) if is_test_item(&function.attrs));
        if !is_test && !file.is_test_file() {
            continue;
        }
        let text = with_comments_above(&file.text, item.span());
        let golden =
            text.parse().is_ok_and(|tokens| has_golden_number(tokens, file.path.contains("/golden")));
        if golden && !text.contains("ORIGIN:") {
            found.push(Violation::new(
                &file.path,
                item.span().start().line,
                "golden numbers without an ORIGIN",
            ));
        }
    }
    found
}

/// The lines of an item and the comment lines directly above it.
fn with_comments_above(text: &str, span: Span) -> String {
    let lines: Vec<&str> = text.lines().collect();
    let (mut start, end) = (span.start().line - 1, span.end().line);
    while start > 0 && lines[start - 1].trim_start().starts_with("//") {
        start -= 1;
    }
    lines[start..end].join("\n")
}

/// Whether a number of four digits or more stands among the tokens: anywhere, or in an assertion
/// only.
fn has_golden_number(tokens: TokenStream, anywhere: bool) -> bool {
    let mut word = String::new();
    tokens.into_iter().any(|token| match token {
        TokenTree::Group(group) => has_golden_number(group.stream(), anywhere || word.starts_with("assert")),
        TokenTree::Literal(literal) => anywhere && significant_digits(&literal.to_string()) >= 4,
        TokenTree::Ident(ident) => {
            word = ident.to_string();
            false
        }
        TokenTree::Punct(sign) => {
            if sign.as_char() != '!' {
                word.clear();
            }
            false
        }
    })
}

/// Significant digits of a floating-point literal; trailing zeros of a whole number count for
/// nothing.
fn significant_digits(literal: &str) -> usize {
    let number = literal.replace('_', "");
    if number.parse::<f64>().is_err() || !number.contains(['.', 'e']) {
        return 0;
    }
    let mantissa = number.split('e').next().unwrap_or_default();
    let digits: String = mantissa.chars().filter(char::is_ascii_digit).collect();
    let without_leading = digits.trim_start_matches('0');
    if mantissa.ends_with(".0") { without_leading.trim_end_matches('0').len() } else { without_leading.len() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn messages(text: &str) -> Vec<String> {
        let files = [("crates/hydraulics/tests/golden_tables.rs", text), ("comparisons/recompute.py", "")];
        check(&Repository::from_texts(&files)).iter().map(Violation::to_string).collect()
    }

    #[test]
    fn digits_are_counted() {
        for (literal, digits) in [
            ("2.233e6", 4),
            ("0.00025", 2),
            ("1000.0", 1),
            ("12.70", 4),
            ("1e-9", 1),
            ("2233000", 0),
            ("\"1.2345\"", 0),
        ] {
            assert_eq!(significant_digits(literal), digits, "{literal}");
        }
    }

    #[test]
    fn tests_beside_the_code_count_and_the_code_does_not() {
        let count = |text| check(&Repository::from_texts(&[("crates/hydraulics/src/line.rs", text)])).len();
        assert_eq!(count("fn f() { assert!(g() < 2.233e6); }"), 0);
        assert_eq!(count("#[cfg(test)] mod tests { #[test] fn f() { assert!(g() < 2.233e6); } }"), 1);
    }

    #[test]
    fn elsewhere_assertions_count_and_inputs_do_not() {
        let count = |text| check(&Repository::from_texts(&[("crates/hydraulics/tests/line.rs", text)])).len();
        assert_eq!(count("fn f() { for p in [69.9995e5] { g(p); } }"), 0);
        assert_eq!(count("fn f() { assert!((g() - 2.233e6).abs() < 1.0); }"), 1);
        assert_eq!(count("fn f() { assert!((g() - 2.233e6).abs() < 1.0); // ORIGIN: analytic\n}"), 0);
    }

    #[test]
    fn golden_numbers_name_their_origin() {
        let bare = "fn stiffness() { assert!(close(k(), 2.233e6)); }";
        assert_eq!(
            messages(bare),
            ["crates/hydraulics/tests/golden_tables.rs:1: golden numbers without an ORIGIN"]
        );
        assert!(messages(&format!("// ORIGIN: thesis Table 6.2\n{bare}")).is_empty());
        assert!(
            messages("fn stiffness() {\n    // ORIGIN: analytic\n    close(k(), 2.233e6);\n}").is_empty()
        );
        assert!(messages("fn stiffness() { close(k(), 2.2e6, 1e-9); }").is_empty());
    }

    #[test]
    fn an_origin_is_of_a_known_kind_and_exists() {
        assert!(
            messages("// ORIGIN: recomputed by comparisons/recompute.py\nconst K: f64 = 2.233e6;").is_empty()
        );
        assert_eq!(
            messages("// ORIGIN: recomputed by comparisons/lost.py\nconst K: f64 = 2.233e6;").len(),
            1
        );
        assert!(
            messages("// ORIGIN: Machado, Oliveira and Fernandes (2009)\nconst K: f64 = 2.233e6;").is_empty()
        );
        assert_eq!(messages("// ORIGIN: as the program printed it\nconst K: f64 = 2.233e6;").len(), 1);
    }
}
