//! Every invariant of ARCHITECTURE.md names what enforces it, and that exists: a tidy check, a
//! stage of the test command, or a test.

use super::links::{code_spans, prose_lines};
use super::{CHECKS, Violation};
use crate::ci::STAGE_NAMES;
use crate::repository::{Repository, RustFile};

const DOCUMENT: &str = "ARCHITECTURE.md";
const ENFORCED: &str = "Enforced by";

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let Some(text) = repository.text(DOCUMENT) else {
        return vec![Violation::new(DOCUMENT, 0, "does not exist")];
    };
    let mut found = Vec::new();
    for (line, paragraph) in invariants(text) {
        let named = paragraph.split_once(ENFORCED).map(|(_, after)| code_spans(after)).unwrap_or_default();
        if named.is_empty() {
            found.push(Violation::new(
                DOCUMENT,
                line,
                format!("an invariant without \"{ENFORCED}\" and a name"),
            ));
        }
        let lost = named.into_iter().filter(|name| !enforces(repository, name));
        found.extend(lost.map(|name| {
            Violation::new(
                DOCUMENT,
                line,
                format!("`{name}` is no tidy check, no stage, no file and no test"),
            )
        }));
    }
    found
}

/// The numbered items below the heading "Invariants", each on one line.
fn invariants(text: &str) -> Vec<(usize, String)> {
    let below = prose_lines(text).skip_while(|(_, line)| *line != "## Invariants").skip(1);
    let mut items: Vec<(usize, String)> = Vec::new();
    for (number, line) in below.take_while(|(_, line)| !line.starts_with("## ")) {
        if line.starts_with(|c: char| c.is_ascii_digit()) {
            items.push((number, line.to_string()));
        } else if let Some((_, item)) = items.last_mut().filter(|_| line.starts_with(' ')) {
            item.push(' ');
            item.push_str(line.trim());
        }
    }
    items
}

fn enforces(repository: &Repository, name: &str) -> bool {
    let checked = CHECKS.iter().any(|(check, _)| *check == name) || STAGE_NAMES.contains(&name);
    let is_test =
        |file: &RustFile| file.text.contains(&format!("fn {name}(")) && file.text.contains("#[test]");
    checked || repository.text(name).is_some() || repository.rust_files().iter().any(is_test)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(item: &str) -> usize {
        let text =
            format!("# Architecture\n\n1. not one\n\n## Invariants\n\n{item}\n\n## After\n\n1. not one\n");
        let test = "#[cfg(test)] mod tests { #[test] fn nothing_leaks() {} }";
        check(&Repository::from_texts(&[(DOCUMENT, &text), ("crates/a/src/lib.rs", test)])).len()
    }

    #[test]
    fn an_invariant_names_what_enforces_it() {
        assert_eq!(
            count("1. `qft` is alone. Enforced by the tidy check `purity`\n   and the test `nothing_leaks`."),
            0
        );
        assert_eq!(count("1. Enforced by the stage `wasm32`."), 0);
        assert_eq!(count("1. Nothing leaks, we hope."), 1);
        assert_eq!(count("1. Nothing leaks. Enforced by `goodwill`."), 1);
    }
}
