//! One concept per file, which is named after it: `foo.rs` next to `foo/`, and no file for
//! leftovers. The tests of a package are one program, and no file of tests is left out of it. A
//! library that is not built for tests has none.

use super::Violation;
use crate::repository::Repository;

const LEFTOVERS: [&str; 8] = ["mod", "utils", "util", "common", "helpers", "helper", "misc", "shared"];

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let names = repository.texts("", ".rs").filter_map(|(path, _)| check_name(path));
    names.chain(unnamed_tests(repository)).chain(unbuilt_tests(repository)).collect()
}

/// Unit tests of a library that is not built for tests.
fn unbuilt_tests(repository: &Repository) -> Vec<Violation> {
    let tested = repository.texts("", ".rs").filter(|(_, text)| text.contains("#[cfg(test)]"));
    let unbuilt = tested.filter_map(|(path, _)| {
        let manifest = format!("{}/Cargo.toml", path.split_once("/src/")?.0);
        let mut parts = repository.text(&manifest)?.split("\n[");
        let is_unbuilt = parts.any(|part| part.starts_with("lib]") && part.contains("\ntest = false"));
        is_unbuilt.then(|| Violation::new(path, 0, format!("its tests are never built: see {manifest}")))
    });
    unbuilt.collect()
}

/// Files below `tests/` that the file above them does not declare: they would not even be compiled.
fn unnamed_tests(repository: &Repository) -> Vec<Violation> {
    let tests = repository.texts("", ".rs").filter(|(path, _)| path.contains("/tests/"));
    let unnamed = tests.filter_map(|(path, _)| {
        let (folder, name) = path.trim_end_matches(".rs").rsplit_once('/')?;
        let parent =
            if folder.ends_with("/tests") { format!("{folder}/all") } else { folder.to_string() } + ".rs";
        let has_parent = repository.exists(&format!("{}/tests/all.rs", path.split_once("/tests/")?.0));
        let declares = |line: &str| line.contains("mod ") && line.ends_with(&format!(" {name};"));
        let declared = || repository.text(&parent).is_some_and(|text| text.lines().any(declares));
        let is_lost = has_parent && parent != path && !declared();
        is_lost.then(|| Violation::new(path, 0, format!("lacks `mod {name};` in {parent}")))
    });
    unnamed.collect()
}

fn check_name(path: &str) -> Option<Violation> {
    let mut parts = path.trim_end_matches(".rs").split('/');
    let leftover = parts.find(|part| LEFTOVERS.contains(part))?;
    let remedy = if leftover == "mod" { "foo.rs next to foo/" } else { "the concept it holds" };
    Some(Violation::new(path, 0, format!("named `{leftover}`: name it after {remedy}")))
}
