//! NOTATION.md names only existing identifiers, and every parameter of the actuator.
//!
//! In every table that has a column `identifier`, each code span of that column is a word of the
//! code or `Type::member`. A parameter is named by its word, or by `Type::word` if the word is
//! ambiguous.

use std::collections::{BTreeMap, BTreeSet};

use super::Violation;
use super::links::{code_spans, prose_lines};
use super::parameters::{Parameter, parameters};
use crate::repository::Repository;
use crate::rust_file::words;

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
        let without_identifier = identifiers.is_empty().then_some("a row without an identifier");
        let without_unit = "a row without a unit (write 1 for a plain number)";
        let without_unit = row.cell("SI unit").is_empty().then_some(without_unit);
        let messages = without_identifier.into_iter().chain(without_unit);
        found.extend(messages.map(|message| Violation::new(DOCUMENT, row.line, message)));
        found.extend(vocabulary.unknown(DOCUMENT, row.line, &identifiers));
        named.extend(identifiers);
    }
    for Parameter { path, line, owner, name } in parameters(repository) {
        if !named.contains(name) && !named.contains(format!("{owner}::{name}").as_str()) {
            let message = format!("the parameter `{owner}::{name}` has no row in {DOCUMENT}");
            found.push(Violation::new(path, line, message));
        }
    }
    found
}

/// A row of a table, with the header that names its columns.
pub(super) struct Row<'a> {
    pub(super) line: usize,
    cells: BTreeMap<&'a str, &'a str>,
}

impl<'a> Row<'a> {
    /// The cell in this column; empty if there is none.
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

/// The cells of a table's line; none if the line is not part of a table.
fn cells(line: &str) -> Vec<&str> {
    let inner = line.trim().strip_prefix('|').and_then(|rest| rest.strip_suffix('|'));
    inner.map(|inner| inner.split('|').map(str::trim).collect()).unwrap_or_default()
}

/// Every word of the code in `crates/`, without comments and string literals.
pub(super) struct Vocabulary<'a>(BTreeSet<&'a str>);

impl Vocabulary<'_> {
    pub(super) fn of(repository: &Repository) -> Vocabulary<'_> {
        let libraries = repository.rust_files.iter().filter(|file| file.path.starts_with("crates/"));
        Vocabulary(libraries.flat_map(|file| &file.lines).flat_map(|line| words(&line.code)).collect())
    }

    /// Reports those names of which some part is not a word of the code.
    pub(super) fn unknown(&self, document: &str, line: usize, names: &[&str]) -> Vec<Violation> {
        let is_known = |name: &&&str| name.split("::").all(|word| self.0.contains(word));
        let unknown = names.iter().filter(|name| !is_known(name));
        let message = |name| format!("`{name}` is no word of the code in crates/");
        unknown.map(|name| Violation::new(document, line, message(name))).collect()
    }
}
