//! NOTATION.md names what exists.
//!
//! A table whose header has the columns `symbol` and `identifier` is a table of notation: each code span in the identifier
//! column is a word of the code, or `Type::member`, both of them.

use std::collections::BTreeSet;

use super::Violation;
use super::links::{code_spans, prose_lines};
use crate::repository::Repository;

const DOCUMENT: &str = "NOTATION.md";

/// One row of a table of notation.
struct Row<'a> {
    line: usize,
    identifiers: Vec<&'a str>,
}

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let Some(text) = repository.text(DOCUMENT) else {
        return vec![Violation::new(DOCUMENT, 0, "does not exist")];
    };
    let libraries = repository.rust_files().iter().filter(|file| file.path.starts_with("crates/"));
    let words: BTreeSet<String> = libraries.flat_map(|file| file.words()).collect();
    let mut found = Vec::new();
    for row in rows(text) {
        if row.identifiers.is_empty() {
            found.push(Violation::new(DOCUMENT, row.line, "a row without an identifier"));
        }
        let unknown =
            row.identifiers.iter().filter(|name| !name.split("::").all(|word| words.contains(word)));
        found.extend(unknown.map(|name| {
            Violation::new(DOCUMENT, row.line, format!("`{name}` is no word of the code in crates/"))
        }));
    }
    found
}

fn rows(text: &str) -> Vec<Row<'_>> {
    let mut rows = Vec::new();
    let mut column = None;
    for (line, content) in prose_lines(text) {
        let cells = cells(content);
        match column {
            _ if cells.is_empty() => column = None,
            None => column = cells.iter().position(|cell| *cell == "identifier"),
            Some(column) if !content.contains("---") => {
                let identifiers = cells.get(column).map(|cell| code_spans(cell)).unwrap_or_default();
                rows.push(Row { line, identifiers });
            }
            Some(_) => {}
        }
    }
    rows
}

/// The cells of a table's line; none where the line is no part of a table.
pub(super) fn cells(line: &str) -> Vec<&str> {
    let inner = line.trim().strip_prefix('|').and_then(|rest| rest.strip_suffix('|'));
    inner.map(|inner| inner.split('|').map(str::trim).collect()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    const CODE: &str = "/// x_p\npub struct Cylinder { pub bulk_modulus: f64 }";

    fn messages(rows: &str) -> Vec<String> {
        let text =
            format!("# Notation\n| symbol | identifier | unit |\n|---|---|---|\n{rows}\n\nSee `anything`.\n");
        let files = [("NOTATION.md", text.as_str()), ("crates/a/src/lib.rs", CODE)];
        check(&Repository::from_texts(&files)).iter().map(Violation::to_string).collect()
    }

    #[test]
    fn identifiers_are_words_of_the_code() {
        assert!(messages("| β_0 | `bulk_modulus`, `Cylinder::bulk_modulus` | Pa |").is_empty());
        assert_eq!(
            messages("| x_p | `x_p` | m |"),
            ["NOTATION.md:4: `x_p` is no word of the code in crates/"]
        );
        assert_eq!(messages("| A | `Cylinder::area` | m2 |").len(), 1);
    }

    #[test]
    fn a_row_names_something() {
        assert_eq!(messages("| x_p | position | m |").len(), 1);
    }

    #[test]
    fn the_document_exists() {
        assert_eq!(check(&Repository::from_texts(&[])).len(), 1);
    }
}
