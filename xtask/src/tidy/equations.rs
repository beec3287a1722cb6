//! Equations of the thesis that the code cites are in the book's index of equations; the
//! implementation named in the index exists, and the named file contains the equation as a formula.
//! For an equation of another source the index states the beginning of the formula.

use std::collections::BTreeSet;

use super::Violation;
use super::citation::{Equation, cited, numbers};
use super::notation::{Row, Vocabulary, tables};
use crate::repository::Repository;

const INDEX: &str = "book/src/theory/equations.md";

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let Some(text) = repository.text(INDEX) else {
        return vec![Violation::new(INDEX, 0, "does not exist")];
    };
    let vocabulary = Vocabulary::of(repository);
    let mut found = Vec::new();
    let mut known = BTreeSet::new();
    for row in tables(text, "equation") {
        let equations = numbers(row.cell("equation"));
        if equations.is_empty() {
            found.push(Violation::new(INDEX, row.line, "a row without an equation number such as 6.12"));
        }
        found.extend(vocabulary.unknown(INDEX, row.line, &row.spans("implemented by")));
        found.extend(misplaced(repository, &row, &equations));
        known.extend(equations);
    }
    for row in tables(text, "formula") {
        found.extend(vocabulary.unknown(INDEX, row.line, &row.spans("implemented by")));
        found.extend(missing_formula(repository, &row));
    }
    for (path, text) in repository.texts("crates/", ".rs") {
        for (index, line) in text.lines().enumerate() {
            for (chapter, number) in cited(line).into_iter().filter(|cited| !known.contains(cited)) {
                let message = format!("cites {chapter}.{number}, which {INDEX} does not list");
                found.push(Violation::new(path, index + 1, message));
            }
        }
    }
    found
}

/// The file of a row whose fences do not contain the row's formula.
fn missing_formula(repository: &Repository, row: &Row<'_>) -> Vec<Violation> {
    let [formulae, files] = ["formula", "in"].map(|column| row.spans(column));
    let (&[formula], &[file]) = (formulae.as_slice(), files.as_slice()) else {
        let message = "a row states the beginning of one formula, and one file, each in a code span";
        return vec![Violation::new(INDEX, row.line, message)];
    };
    let spaced = |line: &str| line.split_whitespace().collect::<Vec<_>>().join(" ");
    let holds = |text| fenced(text).any(|line| spaced(line).contains(&spaced(formula)));
    let message = || format!("`{formula}` is in no `text` fence of `{file}`");
    let is_missing = !source(repository, file).is_some_and(holds);
    is_missing.then(|| Violation::new(INDEX, row.line, message())).into_iter().collect()
}

/// The source with this name in the index.
fn source<'a>(repository: &'a Repository, name: &str) -> Option<&'a str> {
    let (package, file) = name.split_once('/')?;
    repository.text(&format!("crates/{package}/src/{file}"))
}

/// Equations of a row that are in no file of the row, and files that contain none of them.
fn misplaced(repository: &Repository, row: &Row<'_>, equations: &[Equation]) -> Vec<Violation> {
    let mut found = Vec::new();
    let mut held = BTreeSet::new();
    for name in row.spans("in") {
        let text = source(repository, name).unwrap_or_default();
        let formulae: BTreeSet<Equation> = fenced(text).flat_map(cited).collect();
        if !equations.iter().any(|equation| formulae.contains(equation)) {
            let message = format!("`{name}` has none of these equations in a `text` fence");
            found.push(Violation::new(INDEX, row.line, message));
        }
        held.extend(formulae);
    }
    let missing = equations.iter().filter(|equation| !held.contains(equation));
    found.extend(missing.map(|(chapter, number)| {
        let message = format!("{chapter}.{number} is in no `text` fence of the files in column `in`");
        Violation::new(INDEX, row.line, message)
    }));
    found
}

/// The lines within the `text` fences of a file's comments.
fn fenced(text: &str) -> impl Iterator<Item = &str> {
    let mut inside = false;
    text.lines().map(|line| line.trim_start().trim_start_matches(['/', '!']).trim()).filter(move |line| {
        inside = match *line {
            "```text" => true,
            "```" => false,
            _ => return inside,
        };
        false
    })
}
