//! NOTATION.md names what exists, and names every parameter of the actuator.
//!
//! In every table that has a column `identifier`, each code span of that column is a word of the
//! code or `Type::member`. A parameter is named by its word, or by `Type::word` where the word
//! alone would be ambiguous.

use std::collections::{BTreeMap, BTreeSet};

use super::Violation;
use super::links::{code_spans, prose_lines};
use super::parameters::{Parameter, parameters};
use crate::repository::Repository;

const DOCUMENT: &str = "NOTATION.md";

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let Some(text) = repository.text(DOCUMENT) else {
        return vec![Violation::new(DOCUMENT, 0, "does not exist")];
    };
    let vocabulary = Vocabulary::of(repository);
    let mut found = Vec::new();
    let mut named = BTreeSet::new();
    for row in tables(text, "identifier") {
        let identifiers = row.spans("identifier");
        if identifiers.is_empty() {
            found.push(Violation::new(DOCUMENT, row.line, "a row without an identifier"));
        }
        if row.cell("SI unit").is_empty() {
            found.push(Violation::new(
                DOCUMENT,
                row.line,
                "a row without a unit (write 1 for a plain number)",
            ));
        }
        found.extend(vocabulary.unknown(&identifiers).into_iter().map(|name| {
            Violation::new(DOCUMENT, row.line, format!("`{name}` is no word of the code in crates/"))
        }));
        named.extend(identifiers);
    }
    let is_named = |Parameter { owner, name, .. }: &Parameter| {
        named.contains(name.as_str()) || named.contains(format!("{owner}::{name}").as_str())
    };
    for parameter in parameters(repository).into_iter().filter(|parameter| !is_named(parameter)) {
        let Parameter { path, line, owner, name } = parameter;
        let message = format!("the parameter `{owner}::{name}` has no row in {DOCUMENT}");
        found.push(Violation::new(&path, line, message));
    }
    found
}

/// One row of a table, with the header that names its columns.
pub(super) struct Row<'a> {
    pub(super) line: usize,
    cells: BTreeMap<&'a str, &'a str>,
}

impl<'a> Row<'a> {
    /// The cell in this column; empty where there is none.
    pub(super) fn cell(&self, column: &str) -> &'a str {
        self.cells.get(column).copied().unwrap_or_default()
    }

    /// The code spans of the cell in this column.
    pub(super) fn spans(&self, column: &str) -> Vec<&'a str> {
        code_spans(self.cell(column))
    }
}

/// The rows of all tables that have this column.
pub(super) fn tables<'a>(text: &'a str, column: &str) -> Vec<Row<'a>> {
    let mut rows = Vec::new();
    let mut header: Vec<&str> = Vec::new();
    for (line, content) in prose_lines(text) {
        let cells = cells(content);
        if cells.is_empty() || header.is_empty() {
            header = cells;
        } else if header.contains(&column) && !cells.iter().all(|cell| cell.starts_with("--")) {
            rows.push(Row { line, cells: header.iter().copied().zip(cells).collect() });
        }
    }
    rows
}

/// The cells of a table's line; none where the line is not part of a table.
fn cells(line: &str) -> Vec<&str> {
    let inner = line.trim().strip_prefix('|').and_then(|rest| rest.strip_suffix('|'));
    inner.map(|inner| inner.split('|').map(str::trim).collect()).unwrap_or_default()
}

/// Every word of the code in `crates/`, comments left out.
pub(super) struct Vocabulary(BTreeSet<String>);

impl Vocabulary {
    pub(super) fn of(repository: &Repository) -> Vocabulary {
        let libraries = repository.rust_files().iter().filter(|file| file.path.starts_with("crates/"));
        Vocabulary(libraries.flat_map(|file| file.words()).collect())
    }

    /// Those names of which some part is not a word.
    pub(super) fn unknown<'a>(&self, names: &[&'a str]) -> Vec<&'a str> {
        let known = |name: &&str| name.split("::").all(|word| self.0.contains(word));
        names.iter().copied().filter(|name| !known(name)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CODE: &str = "
        /// x_p
        pub struct Fluid { pub bulk_modulus: f64, pub name: String }
        impl Fluid { pub fn problems(&self) {} }
        pub struct Answer { pub stiffness: f64 }
    ";
    const ROW: &str = "| β_0 | `Fluid::bulk_modulus` | Pa |";

    fn messages(rows: &str) -> Vec<String> {
        let text = format!(
            "# Notation\n\n| symbol | identifier | SI unit |\n|---|---|---|\n{rows}\n\nSee `anything`.\n"
        );
        let files = [("NOTATION.md", text.as_str()), ("crates/hydraulics/src/lib.rs", CODE)];
        check(&Repository::from_texts(&files)).iter().map(Violation::to_string).collect()
    }

    #[test]
    fn identifiers_are_words_of_the_code() {
        assert!(messages(ROW).is_empty());
        assert_eq!(
            messages(&format!("{ROW}\n| x_p | `x_p` | m |")),
            ["NOTATION.md:6: `x_p` is no word of the code in crates/"]
        );
        assert_eq!(messages(&format!("{ROW}\n| A | `Fluid::area` | m2 |")).len(), 1);
    }

    #[test]
    fn a_row_names_something_and_its_unit() {
        assert_eq!(messages(&format!("{ROW}\n| x_p | position | m |")).len(), 1);
        assert_eq!(messages(&format!("{ROW}\n| K_H | `stiffness` | |")).len(), 1);
    }

    #[test]
    fn parameters_are_named() {
        assert_eq!(
            messages("| K_H | `stiffness` | N/m |"),
            ["crates/hydraulics/src/lib.rs:3: the parameter `Fluid::bulk_modulus` has no row in NOTATION.md"]
        );
    }

    #[test]
    fn the_document_exists() {
        assert_eq!(check(&Repository::from_texts(&[])).len(), 1);
    }
}
