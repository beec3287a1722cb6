//! Invariants of ARCHITECTURE.md name their enforcement, which exists: a tidy check, a stage of the
//! test command, a file or a test.

use super::links::{code_spans, prose_lines};
use super::{CHECKS, Violation};
use crate::ci::stage_names;
use crate::repository::Repository;

const DOCUMENT: &str = "ARCHITECTURE.md";
const ENFORCED: &str = "Enforced by";

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let mut found = Vec::new();
    for (line, item) in invariants(repository.text(DOCUMENT).unwrap_or_default()) {
        let named = item.split_once(ENFORCED).map(|(_, after)| code_spans(after)).unwrap_or_default();
        if named.is_empty() {
            found.push(Violation::new(
                DOCUMENT,
                line,
                format!("an invariant without \"{ENFORCED}\" and a name"),
            ));
        }
        for name in named.into_iter().filter(|name| !enforces(repository, name)) {
            let message = format!("`{name}` is no tidy check, no stage, no file and no test");
            found.push(Violation::new(DOCUMENT, line, message));
        }
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
            item.push_str(&format!(" {}", line.trim()));
        }
    }
    items
}

fn enforces(repository: &Repository, name: &str) -> bool {
    let is_test = || {
        let function = format!("fn {name}(");
        repository.texts("", ".rs").any(|(_, text)| text.contains(&function) && text.contains("#[test]"))
    };
    CHECKS.iter().any(|(check, _)| *check == name)
        || stage_names().any(|stage| stage == name)
        || repository.text(name).is_some()
        || is_test()
}
