//! Every equation of the thesis that the code cites stands in the book's index of equations, what
//! the index says implements it exists, and the file that it names holds the equation as a formula.
//! Of an equation of another source the index states how the formula begins.

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
        found.extend(not_implemented(&vocabulary, &row));
        found.extend(misplaced(repository, &row, &equations));
        known.extend(equations);
    }
    for row in tables(text, "formula") {
        found.extend(not_implemented(&vocabulary, &row));
        found.extend(missing_formula(repository, &row));
    }
    let sources = repository.texts(|path| path.starts_with("crates/") && path.ends_with(".rs"));
    for (path, text) in sources {
        for (index, line) in text.lines().enumerate() {
            let unlisted = cited(line).into_iter().filter(|equation| !known.contains(equation));
            found.extend(unlisted.map(|(chapter, number)| {
                Violation::new(
                    path,
                    index + 1,
                    format!("cites {chapter}.{number}, which {INDEX} does not list"),
                )
            }));
        }
    }
    found
}

/// What a row says implements it, and is not a word of the code.
fn not_implemented(vocabulary: &Vocabulary, row: &Row<'_>) -> Vec<Violation> {
    let unknown = vocabulary.unknown(&row.spans("implemented by")).into_iter();
    unknown
        .map(|name| Violation::new(INDEX, row.line, format!("`{name}` is no word of the code in crates/")))
        .collect()
}

/// The file of a row whose fences do not hold the row's formula.
fn missing_formula(repository: &Repository, row: &Row<'_>) -> Vec<Violation> {
    let [formulae, files] = ["formula", "in"].map(|column| row.spans(column));
    let (&[formula], &[file]) = (formulae.as_slice(), files.as_slice()) else {
        let message = "a row states the beginning of one formula, and one file, each in a code span";
        return vec![Violation::new(INDEX, row.line, message)];
    };
    let wanted = spaced(formula);
    let text = source(repository, file).unwrap_or_default();
    let holds = fenced(text).any(|line| spaced(line).contains(&wanted));
    let message = || format!("`{formula}` stands in no `text` fence of `{file}`");
    (!holds).then(|| Violation::new(INDEX, row.line, message())).into_iter().collect()
}

/// The words of a line with one space between them.
fn spaced(line: &str) -> String {
    line.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The source that the index calls so.
fn source<'a>(repository: &'a Repository, name: &str) -> Option<&'a str> {
    let (package, file) = name.split_once('/')?;
    repository.text(&format!("crates/{package}/src/{file}"))
}

/// Equations of a row that no file of the row holds, and files that hold none of them.
fn misplaced(repository: &Repository, row: &Row<'_>, equations: &[Equation]) -> Vec<Violation> {
    let mut found = Vec::new();
    let mut held = BTreeSet::new();
    for name in row.spans("in") {
        let formulae = source(repository, name).map(formulae).unwrap_or_default();
        if !equations.iter().any(|equation| formulae.contains(equation)) {
            let message = format!("`{name}` has none of these equations in a `text` fence");
            found.push(Violation::new(INDEX, row.line, message));
        }
        held.extend(formulae);
    }
    let missing = equations.iter().filter(|equation| !held.contains(equation));
    found.extend(missing.map(|(chapter, number)| {
        let message = format!("{chapter}.{number} stands in no `text` fence of the files in column `in`");
        Violation::new(INDEX, row.line, message)
    }));
    found
}

/// The equations cited within the `text` fences of a file's comments.
fn formulae(text: &str) -> BTreeSet<Equation> {
    fenced(text).flat_map(cited).collect()
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

#[cfg(test)]
mod tests {
    use super::*;

    const CODE: &str =
        "/// ```text\n/// B = 1     thesis (6.18), (6.20)\n/// ```\npub fn effective_modulus() {}\n";

    fn messages(rows: &str) -> Vec<String> {
        let head = "| equation | gives | implemented by | in |\n|---|---|---|---|\n";
        let index = format!("{head}{rows}\n");
        let files = [(INDEX, index.as_str()), ("crates/hydraulics/src/line.rs", CODE)];
        check(&Repository::from_texts(&files)).iter().map(Violation::to_string).collect()
    }

    #[test]
    fn what_is_cited_is_listed() {
        assert!(messages("| 6.18, 6.20 | modulus | `effective_modulus` | `hydraulics/line.rs` |").is_empty());
        assert_eq!(
            messages("| 6.20 | modulus | `effective_modulus` | `hydraulics/line.rs` |"),
            ["crates/hydraulics/src/line.rs:2: cites 6.18, which book/src/theory/equations.md does not list"]
        );
    }

    #[test]
    fn what_is_listed_exists() {
        let messages = |row: &str| messages(&format!("| 6.18, 6.20 | modulus | {row} |"));
        assert_eq!(messages("`series_modulus` | `hydraulics/line.rs`").len(), 1);
        assert_eq!(messages("`effective_modulus` | `hydraulics/line.rs` |\n| six | x | not yet |").len(), 1);
    }

    #[test]
    fn an_equation_stands_as_a_formula_where_the_index_says() {
        let row = |equations: &str, file: &str| {
            messages(&format!("| {equations} | modulus | `effective_modulus` | {file} |"))
        };
        let place = "book/src/theory/equations.md:3";
        assert_eq!(
            row("6.18 to 6.20", "`hydraulics/line.rs`"),
            [format!("{place}: 6.19 stands in no `text` fence of the files in column `in`")]
        );
        assert_eq!(row("6.18, 6.20", "`hydraulics/line.rs`, `hydraulics/hose.rs`").len(), 1);
        assert_eq!(row("6.18, 6.20", "").len(), 2);
    }

    #[test]
    fn an_equation_of_another_source_stands_where_its_row_says() {
        let messages = |row: &str| {
            let head = "| formula | gives | implemented by | in |\n|---|---|---|---|\n";
            let text = format!("{head}{row}\n");
            let code = CODE.replace("thesis (6.18), (6.20)", "for a rigid line");
            let files = [(INDEX, text.as_str()), ("crates/hydraulics/src/line.rs", code.as_str())];
            check(&Repository::from_texts(&files)).iter().map(Violation::to_string).collect::<Vec<_>>()
        };
        assert!(
            messages("| `B = 1 for` | modulus | `effective_modulus` | `hydraulics/line.rs` |").is_empty()
        );
        assert_eq!(
            messages("| `B = 2` | modulus | `effective_modulus` | `hydraulics/line.rs` |"),
            [format!("{INDEX}:3: `B = 2` stands in no `text` fence of `hydraulics/line.rs`")]
        );
        assert_eq!(messages("| `B = 1` | modulus | `lost` | `hydraulics/lost.rs` |").len(), 2);
        assert_eq!(messages("| B = 1 | modulus | `effective_modulus` | |").len(), 1);
    }
}
