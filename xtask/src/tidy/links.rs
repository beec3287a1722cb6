//! Every path and link that a document names exists, in prose, in code spans and in the commands of
//! console blocks.

use super::Violation;
use crate::repository::Repository;

/// Folders at the root; a code span that begins with one of them counts as a path.
const FOLDERS: [&str; 7] = ["crates/", "apps/", "book/", "examples/", "xtask/", "comparisons/", ".ci/"];

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    repository.texts("", ".md").flat_map(|(path, text)| check_document(repository, path, text)).collect()
}

fn check_document(repository: &Repository, path: &str, text: &str) -> Vec<Violation> {
    let mut found = Vec::new();
    for (number, line) in prose_lines(text) {
        let links =
            link_targets(line).into_iter().map(|target| (check_link(repository, path, target), target));
        let spans = code_spans(line).into_iter().map(|span| (check_span(repository, span), span));
        let broken = links.chain(spans).filter(|(fine, _)| !fine);
        found.extend(
            broken.map(|(_, target)| Violation::new(path, number, format!("`{target}` does not exist"))),
        );
    }
    // Stories run in their own folders; the files that they name are checked when they run.
    for (number, line) in commands(text).filter(|_| !path.starts_with("examples/")) {
        let lost = line.split_whitespace().filter(|word| !check_span(repository, word));
        found.extend(lost.map(|word| Violation::new(path, number, format!("`{word}` does not exist"))));
    }
    found
}

/// The commands in console blocks: lines that start with a dollar sign.
fn commands(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut console = false;
    text.lines().enumerate().filter_map(move |(index, line)| {
        if line.trim_start().starts_with("```") {
            console = !console && line.trim() == "```console";
        }
        line.strip_prefix("$ ").filter(|_| console).map(|command| (index + 1, command))
    })
}

/// The lines outside fenced code, with their numbers.
pub(super) fn prose_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut fenced = false;
    text.lines().enumerate().filter_map(move |(index, line)| {
        let fence = line.trim_start().starts_with("```");
        let prose = !fenced && !fence;
        fenced ^= fence;
        prose.then_some((index + 1, line))
    })
}

/// The targets of `[text](target)`.
fn link_targets(line: &str) -> Vec<&str> {
    let after = line.split("](").skip(1);
    after
        .filter_map(|rest| rest.split(')').next())
        .map(|target| target.split(' ').next().unwrap_or(target))
        .collect()
}

/// Texts between single backticks.
pub(super) fn code_spans(line: &str) -> Vec<&str> {
    line.split('`').skip(1).step_by(2).collect()
}

fn check_link(repository: &Repository, from: &str, target: &str) -> bool {
    if target.contains("://") || target.starts_with("mailto:") {
        return true;
    }
    let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
    let place = if file.is_empty() { from.to_string() } else { resolved(from, file) };
    let heading =
        |text: &str| prose_lines(text).any(|(_, line)| line.starts_with('#') && slug(line) == anchor);
    repository.exists(&place) && (anchor.is_empty() || repository.text(&place).is_some_and(heading))
}

/// The path that `target` means in a document at `from`.
fn resolved(from: &str, target: &str) -> String {
    let mut parts: Vec<&str> = from.split('/').collect();
    parts.pop();
    for part in target.split('/') {
        match part {
            "" | "." => {}
            ".." => {
                parts.pop();
            }
            name => parts.push(name),
        }
    }
    parts.join("/")
}

/// The anchor of a heading: lower case, spaces replaced by hyphens, other signs dropped.
fn slug(heading: &str) -> String {
    let words = heading.trim_start_matches('#').trim().to_lowercase();
    let characters = words.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    characters.map(|c| if c == ' ' { '-' } else { c }).collect()
}

/// Checks a code span that has the form of a path of the repository: it must exist; `*` and
/// capitals as in `NAME` match anything.
fn check_span(repository: &Repository, span: &str) -> bool {
    let looks_like_path = FOLDERS.iter().any(|folder| span.starts_with(folder)) && !span.contains(' ');
    let placeholder =
        |part: &str| part.contains(['*', '<', '{']) || part.chars().next().is_some_and(char::is_uppercase);
    let known: Vec<&str> = span.split('/').take_while(|part| !placeholder(part)).collect();
    !looks_like_path || repository.exists(&known.join("/"))
}
