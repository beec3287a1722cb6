//! File sizes: a file has at most 500 lines, a function of Python fits on a screen, and the
//! overview on a few pages. For functions of Rust see `too-many-lines-threshold` in clippy.toml.

use super::Violation;
use crate::repository::Repository;

const LARGEST_FILE: usize = 500;
/// File that a script writes.
const GENERATED: &str = "apps/python/python/phea/answers.py";
const LONGEST_FUNCTION: usize = 60;
const OVERVIEW: (&str, usize) = ("ARCHITECTURE.md", 120);

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let sources = repository.texts("", ".rs").chain(repository.texts("", ".py"));
    let limited = sources.filter(|(path, _)| *path != GENERATED);
    let mut found = Vec::new();
    for (path, text) in limited.chain(repository.texts(OVERVIEW.0, "")) {
        let most = if path == OVERVIEW.0 { OVERVIEW.1 } else { LARGEST_FILE };
        let lines = text.lines().count();
        if lines > most {
            let message = format!("{lines} lines, {most} are allowed: split it by concept");
            found.push(Violation::new(path, 0, message));
        }
    }
    for (path, text) in repository.texts("", ".py") {
        for (line, body) in python_functions(text).filter(|(_, body)| *body > LONGEST_FUNCTION) {
            let message = format!("a function of {body} lines, {LONGEST_FUNCTION} are allowed");
            found.push(Violation::new(path, line, message));
        }
    }
    found
}

/// Python's functions, by their first line and the number of the others: a `def` extends to the
/// last line that is indented further.
fn python_functions(text: &str) -> impl Iterator<Item = (usize, usize)> {
    let indentation = |line: &str| line.len() - line.trim_start().len();
    let lines: Vec<&str> = text.lines().collect();
    let starts = text.lines().enumerate().filter(|(_, line)| line.trim_start().starts_with("def "));
    starts.map(move |(start, def)| {
        let is_inside = |line: &&&str| {
            line.trim().is_empty() || indentation(line) > indentation(def) || line.trim() == "):"
        };
        let body: Vec<&&str> = lines[start + 1..].iter().take_while(is_inside).collect();
        (start + 1, body.iter().rposition(|line| !line.trim().is_empty()).map_or(0, |last| last + 1))
    })
}
