//! One concept a file, named after it: `foo.rs` next to `foo/`, no drawer for leftovers. The tests
//! of a package are one program, and no file of tests is left out of it. Unit tests of a library
//! that is not built for tests are built by that program.

use super::Violation;
use crate::repository::Repository;

const LEFTOVERS: [&str; 8] = ["mod", "utils", "util", "common", "helpers", "helper", "misc", "shared"];

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let names = repository.texts(|path| path.ends_with(".rs")).filter_map(|(path, _)| check_name(path));
    names.chain(unnamed_tests(repository)).chain(unbuilt_tests(repository)).collect()
}

/// Unit tests of a library that is not built for tests, which no file below `tests/` builds.
fn unbuilt_tests(repository: &Repository) -> Vec<Violation> {
    let sources = repository.texts(|path| path.ends_with(".rs") && path.contains("/src/"));
    let unbuilt = sources.filter(|(_, text)| text.contains("#[cfg(test)]")).filter_map(|(path, _)| {
        let (package, file) = path.split_once("/src/")?;
        let manifest = repository.text(&format!("{package}/Cargo.toml"))?;
        let is_built =
            !manifest.split("\n[").any(|part| part.starts_with("lib]") && part.contains("\ntest = false"));
        let (tests, named) = (format!("{package}/tests/"), format!("/src/{file}\""));
        let is_named = || {
            let mut all = repository.texts(|path| path.starts_with(&tests) && path.ends_with(".rs"));
            all.any(|(_, text)| text.contains(&named))
        };
        let lacks = || format!("its tests are never built: name it in {tests}kernels.rs");
        (!is_built && !is_named()).then(|| Violation::new(path, 0, lacks()))
    });
    unbuilt.collect()
}

/// Files below `tests/` that the file above them does not declare: they would not even be compiled.
fn unnamed_tests(repository: &Repository) -> Vec<Violation> {
    let tests = repository.texts(|path| path.ends_with(".rs") && path.contains("/tests/"));
    let unnamed = tests.filter_map(|(path, _)| {
        let (folder, name) = path.trim_end_matches(".rs").rsplit_once('/')?;
        let parent =
            if folder.ends_with("/tests") { format!("{folder}/all.rs") } else { format!("{folder}.rs") };
        if parent == path || !repository.exists(&format!("{}/tests/all.rs", path.split_once("/tests/")?.0)) {
            return None;
        }
        let declared = repository.text(&parent).is_some_and(|text| declares(text, name));
        (!declared).then(|| Violation::new(path, 0, format!("lacks `mod {name};` in {parent}")))
    });
    unnamed.collect()
}

fn declares(text: &str, name: &str) -> bool {
    text.lines().any(|line| {
        line.strip_suffix(';').is_some_and(|line| {
            line.rsplit(char::is_whitespace).next() == Some(name) && line.contains("mod ")
        })
    })
}

fn check_name(path: &str) -> Option<Violation> {
    let mut parts = path.trim_end_matches(".rs").split('/');
    let leftover = parts.find(|part| LEFTOVERS.contains(part))?;
    let cure = if leftover == "mod" { "foo.rs next to foo/" } else { "the concept it holds" };
    Some(Violation::new(path, 0, format!("named `{leftover}`: name it after {cure}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drawers_are_refused_and_modules_about_moduli_are_not() {
        for path in ["crates/a/src/b/mod.rs", "crates/a/src/utils.rs", "crates/a/src/common/line.rs"] {
            assert!(check_name(path).is_some(), "{path}");
        }
        for path in ["crates/a/src/modulus.rs", "crates/a/src/line.rs"] {
            assert!(check_name(path).is_none(), "{path}");
        }
    }

    #[test]
    fn every_file_of_tests_is_declared() {
        let found = |all: &str| {
            let files = [
                ("crates/a/tests/all.rs", all),
                ("crates/a/tests/laws.rs", "mod limits;\n"),
                ("crates/a/tests/laws/limits.rs", ""),
                ("crates/a/tests/laws/lost.rs", ""),
                ("benches/b/tests/courses.rs", ""),
            ];
            check(&Repository::from_texts(&files)).iter().map(Violation::to_string).collect::<Vec<_>>()
        };
        let lost = "crates/a/tests/laws/lost.rs: lacks `mod lost;` in crates/a/tests/laws.rs";
        assert_eq!(found("mod laws;\n"), [lost]);
        let laws = "crates/a/tests/laws.rs: lacks `mod laws;` in crates/a/tests/all.rs";
        assert_eq!(found("mod flaws;\n"), [laws, lost]);
    }

    #[test]
    fn unit_tests_that_nothing_builds_are_refused() {
        let found = |manifest: &str, kernels: &str| {
            let files = [
                ("crates/a/Cargo.toml", manifest),
                ("crates/a/src/laws/limit.rs", "#[cfg(test)]\nmod tests {}\n"),
                ("crates/a/tests/kernels.rs", kernels),
            ];
            unbuilt_tests(&Repository::from_texts(&files))
                .iter()
                .map(Violation::to_string)
                .collect::<Vec<_>>()
        };
        let unbuilt = "[package]\nname = \"a\"\n\n[lib]\ntest = false\n";
        let named = "#[path = \"../src/laws/limit.rs\"]\nmod limit;\n";
        let told =
            "crates/a/src/laws/limit.rs: its tests are never built: name it in crates/a/tests/kernels.rs";
        assert_eq!(found(unbuilt, ""), [told]);
        assert!(found(unbuilt, named).is_empty());
        let built = "[lib]\nbench = false\n\n[[test]]\nname = \"all\"\ntest = false\n";
        assert!(found(built, "").is_empty());
    }
}
