//! Every path and link that a document names exists, in prose, in code spans and in the commands of
//! console blocks. The book's table of contents lists every page, and the README every story.

use super::Violation;
use crate::repository::Repository;

/// Folders at the root; a code span that begins with one of them counts as a path.
const FOLDERS: [&str; 7] = ["crates/", "apps/", "book/", "examples/", "xtask/", "comparisons/", ".ci/"];

/// Pages that the table of contents lacks, and stories that the README lacks.
pub(super) fn check_listed(repository: &Repository) -> Vec<Violation> {
    let unlisted = |path: &str, document: &str, link: &str| {
        let is_listed = repository.text(document).is_some_and(|text| text.contains(&format!("]({link})")));
        let message = format!("is not listed in {document}");
        (!is_listed && path != document).then(|| Violation::new(path, 0, message))
    };
    let pages =
        repository.texts("book/src/", ".md").map(|(path, _)| (path, path.trim_start_matches("book/src/")));
    let pages = pages.filter_map(|(path, link)| unlisted(path, "book/src/SUMMARY.md", link));
    let stories = repository.texts("examples/", ".md").filter(|(_, text)| text.contains("```console"));
    pages.chain(stories.filter_map(|(path, _)| unlisted(path, "README.md", path))).collect()
}

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    repository.texts("", ".md").flat_map(|(path, text)| check_document(repository, path, text)).collect()
}

fn check_document(repository: &Repository, path: &str, text: &str) -> Vec<Violation> {
    let missing = |number, target: &str| Violation::new(path, number, format!("`{target}` does not exist"));
    let mut found = Vec::new();
    for (number, line) in prose_lines(text) {
        let links = link_targets(line).filter(|target| !check_link(repository, path, target));
        let spans = code_spans(line).into_iter().filter(|span| !check_span(repository, span));
        found.extend(links.chain(spans).map(|target| missing(number, target)));
    }
    // Stories run in their own folders; the files that they name are checked when they run.
    for (number, line) in commands(text).filter(|_| !path.starts_with("examples/")) {
        let lost = line.split_whitespace().filter(|word| !check_span(repository, word));
        found.extend(lost.map(|word| missing(number, word)));
    }
    found
}

/// The commands in console blocks: lines that start with a dollar sign.
fn commands(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let console = fenced_lines(text).filter(|(_, _, fence)| *fence == Some("```console"));
    console.filter_map(|(number, line, _)| Some((number, line.strip_prefix("$ ")?)))
}

/// The lines outside fenced code, with their numbers.
pub(super) fn prose_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    fenced_lines(text).filter(|(_, _, fence)| fence.is_none()).map(|(number, line, _)| (number, line))
}

/// The lines except the fences of code, with their numbers, and the fence above those between two.
fn fenced_lines(text: &str) -> impl Iterator<Item = (usize, &str, Option<&str>)> {
    let mut open = None;
    text.lines().enumerate().filter_map(move |(index, line)| {
        let is_fence = line.trim_start().starts_with("```");
        if is_fence {
            open = if open.is_none() { Some(line.trim()) } else { None };
        }
        (!is_fence).then_some((index + 1, line, open))
    })
}

/// The targets of `[text](target)`.
fn link_targets(line: &str) -> impl Iterator<Item = &str> {
    line.split("](").skip(1).filter_map(|rest| rest.split([')', ' ']).next())
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
            ".." => drop(parts.pop()),
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
