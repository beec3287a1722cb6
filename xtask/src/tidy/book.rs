//! The book's table of contents lists every page, and the README every folder of stories.

use super::Violation;
use crate::repository::Repository;

const PAGES: &str = "book/src/";
const CONTENTS: &str = "book/src/SUMMARY.md";
const README: &str = "README.md";

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let mut found = Vec::new();
    let contents = repository.text(CONTENTS).unwrap_or_default();
    for (path, text) in
        repository.texts(|path| path.starts_with(PAGES) && path.ends_with(".md") && path != CONTENTS)
    {
        let page = path.trim_start_matches(PAGES);
        if !contents.contains(&format!("]({page})")) {
            found.push(Violation::new(path, 0, format!("is not listed in {CONTENTS}")));
        }
        let rows = text.lines().enumerate().filter(|(_, line)| has_placeholders(line));
        let place = |(index, _)| Violation::new(path, index + 1, "a name in capitals in place of a number");
        found.extend(rows.map(place));
    }
    let readme = repository.text(README).unwrap_or_default();
    for (path, text) in repository.texts(|path| path.starts_with("examples/") && path.ends_with(".md")) {
        let runs_something = text.contains("```console");
        if runs_something && !readme.contains(&format!("]({path})")) {
            found.push(Violation::new(path, 0, format!("is a story that {README} does not list")));
        }
    }
    found
}

/// Whether a row of a table has two cells in capitals next to each other, as a script fills in.
fn has_placeholders(line: &str) -> bool {
    let is_name = |cell: &str| {
        let cell = cell.trim();
        cell.len() > 3 && cell.bytes().all(|byte| byte.is_ascii_uppercase() || byte == b'_')
    };
    let cells: Vec<bool> = line.split('|').map(is_name).collect();
    line.starts_with('|') && cells.windows(2).any(|pair| pair.iter().all(|is_name| *is_name))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(contents: &str, readme: &str) -> usize {
        let story = "Sizing.\n\n```console\n$ phea size hose.toml\n```\n";
        let files = [
            (CONTENTS, contents),
            ("book/src/theory/errata.md", ""),
            (README, readme),
            ("examples/ybitu/01_hose.md", story),
            ("examples/ybitu/README.md", "no story"),
        ];
        check(&Repository::from_texts(&files)).len()
    }

    #[test]
    fn pages_and_stories_are_listed() {
        assert_eq!(count("- [Errata](theory/errata.md)", "[hose](examples/ybitu/01_hose.md)"), 0);
        assert_eq!(count("", "[hose](examples/ybitu/01_hose.md)"), 1);
        assert_eq!(count("- [Errata](theory/errata.md)", ""), 1);
    }

    #[test]
    fn a_table_has_numbers() {
        assert!(has_placeholders("| | wave speed | 535.0 m/s | SPEED | SPEED_W |"));
        assert!(!has_placeholders("| tolerance | phea | CVODE | BDF |"));
        assert!(!has_placeholders("| | wave speed | 535.0 m/s | 380 | 0.11 % |"));
    }
}
