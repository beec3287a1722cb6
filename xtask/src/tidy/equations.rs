//! Every equation of the thesis that the code cites stands in the book's index of equations, and what the index
//! says implements it exists.

use std::collections::BTreeSet;

use super::Violation;
use super::citation::{cited, numbers};
use super::notation::{Vocabulary, tables};
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
        known.extend(equations);
        found.extend(vocabulary.unknown(&row.spans("implemented by")).into_iter().map(|name| {
            Violation::new(INDEX, row.line, format!("`{name}` is no word of the code in crates/"))
        }));
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

#[cfg(test)]
mod tests {
    use super::*;

    const CODE: &str = "/// thesis (6.18), (6.20)\npub fn effective_modulus() {}\n";

    fn messages(rows: &str) -> Vec<String> {
        let head = "| equation | gives | implemented by |\n|---|---|---|\n";
        let index = format!("{head}{rows}\n");
        let files = [(INDEX, index.as_str()), ("crates/hydraulics/src/line.rs", CODE)];
        check(&Repository::from_texts(&files)).iter().map(Violation::to_string).collect()
    }

    #[test]
    fn what_is_cited_is_listed() {
        assert!(messages("| 6.18 to 6.20 | modulus | `effective_modulus` |").is_empty());
        assert_eq!(
            messages("| 6.20 | modulus | `effective_modulus` |"),
            ["crates/hydraulics/src/line.rs:1: cites 6.18, which book/src/theory/equations.md does not list"]
        );
    }

    #[test]
    fn what_is_listed_exists() {
        assert_eq!(messages("| 6.18, 6.20 | modulus | `series_modulus` |").len(), 1);
        assert_eq!(
            messages("| 6.18, 6.20 | modulus | `effective_modulus` |\n| six | x | not yet |").len(),
            1
        );
    }
}
