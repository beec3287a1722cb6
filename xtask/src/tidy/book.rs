//! The book's table of contents lists every page, and the README every folder of stories.

use super::Violation;
use crate::repository::Repository;

const PAGES: &str = "book/src/";
const CONTENTS: &str = "book/src/SUMMARY.md";
const README: &str = "README.md";

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let lists = |document: &str, link: &str| {
        repository.text(document).is_some_and(|text| text.contains(&format!("]({link})")))
    };
    let pages = repository.texts(PAGES, ".md").filter(|(path, _)| {
        let page = path.trim_start_matches(PAGES);
        *path != CONTENTS && !lists(CONTENTS, page)
    });
    let stories = repository.texts("examples/", ".md");
    let stories = stories.filter(|(path, text)| text.contains("```console") && !lists(README, path));
    let unlisted = |document: &'static str| {
        move |(path, _): (&str, _)| Violation::new(path, 0, format!("is not listed in {document}"))
    };
    pages.map(unlisted(CONTENTS)).chain(stories.map(unlisted(README))).collect()
}
