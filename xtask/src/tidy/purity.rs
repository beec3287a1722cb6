//! The three lower crates compute and do nothing else: no file, clock, thread, environment, hashed
//! iteration order or serialisation. No library crate opens a path: only shells do.

use super::Violation;
use super::dependencies::LOWER_CRATES;
use crate::repository::Repository;

/// Forbidden in every library crate, and why.
const FOR_LIBRARIES: [(&str, &str); 5] = [
    ("std::fs", "only shells open paths; take text or bytes"),
    ("std::net", "only shells reach outside"),
    ("std::process", "only shells start processes"),
    ("std::env", "only shells read the environment"),
    ("rand", "random numbers come from an explicit seed of our own generator"),
];

/// Forbidden besides in the crates below the workbench.
const FOR_LOWER_CRATES: [(&str, &str); 9] = [
    ("std::time", "results do not depend on a clock"),
    ("std::thread", "whoever holds the loop owns the threads"),
    ("std::sync", "whoever holds the loop owns the threads"),
    ("std::io", "models read and write nothing"),
    ("std::collections::HashMap", "its order differs between runs; use BTreeMap"),
    ("std::collections::HashSet", "its order differs between runs; use BTreeSet"),
    ("serde", "files and JSON belong to the workbench"),
    ("Serialize", "files and JSON belong to the workbench"),
    ("Deserialize", "files and JSON belong to the workbench"),
];

/// Allowed although it lies below what is forbidden: it waits for nobody.
const SHARED: &str = "std::sync::Arc";

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let mut found = Vec::new();
    for file in repository.rust_files().iter().filter(|file| file.path.starts_with("crates/")) {
        let lower = LOWER_CRATES.iter().any(|folder| file.path.starts_with(folder));
        for (path, line) in file.shipped().paths {
            let rules = FOR_LIBRARIES.iter().chain(if lower { &FOR_LOWER_CRATES[..] } else { &[] });
            let is_shared = is_below(&path, SHARED);
            for (forbidden, reason) in rules.filter(|(forbidden, _)| !is_shared && is_below(&path, forbidden))
            {
                found.push(Violation::new(&file.path, line, format!("uses {forbidden}: {reason}")));
            }
        }
    }
    found.dedup();
    found
}

/// Whether `path` is `forbidden` or something inside it.
fn is_below(path: &str, forbidden: &str) -> bool {
    path.strip_prefix(forbidden).is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(path: &str, text: &str) -> usize {
        check(&Repository::from_texts(&[(path, text)])).len()
    }

    #[test]
    fn lower_crates_touch_neither_files_nor_clocks_nor_threads() {
        for text in [
            "use std::fs;",
            "use std::{time::Instant, fmt};",
            "fn f() { std::thread::spawn(g); }",
            "use std::collections::{BTreeMap, HashMap};",
            "#[derive(Clone, Serialize)] struct A;",
            "use serde::Serialize;",
            "fn f() -> u8 { rand::random() }",
        ] {
            assert_ne!(count("crates/qft/src/lib.rs", text), 0, "{text}");
        }
        assert_eq!(count("crates/qft/src/lib.rs", "use std::fmt; use std::collections::BTreeMap;"), 0);
        assert_eq!(count("crates/qft/src/lib.rs", "mod tests_of { fn rand_like() {} }"), 0);
    }

    #[test]
    fn the_workbench_serialises_but_opens_nothing() {
        assert_eq!(count("crates/workbench/src/answer.rs", "use serde::Serialize;"), 0);
        assert_eq!(count("crates/workbench/src/project.rs", "fn f() { std::fs::read(p); }"), 1);
    }

    #[test]
    fn shells_may_open_paths_and_tests_may_too() {
        assert_eq!(count("apps/cli/src/main.rs", "use std::fs;"), 0);
        assert_eq!(count("crates/workbench/tests/corpus.rs", "use std::fs;"), 0);
        assert_eq!(count("crates/workbench/src/a.rs", "#[cfg(test)] mod tests { use std::fs; }"), 0);
    }
}
