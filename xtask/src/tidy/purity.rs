//! Purity of the crates that only compute: no file, clock, thread, environment, hashed order or
//! serialisation. No library crate opens a path: only shells do.

use super::Violation;
use super::dependencies::LOWER_CRATES;
use crate::repository::Repository;
use crate::rust_file::paths;

/// Items forbidden in every library crate, with the reason.
const FOR_LIBRARIES: [(&str, &str); 5] = [
    ("std::fs", "only shells open paths; take text or bytes"),
    ("std::net", "only shells reach outside"),
    ("std::process", "only shells start processes"),
    ("std::env", "only shells read the environment"),
    ("rand", "random numbers come from an explicit seed of our own generator"),
];

/// Items forbidden in the crates that compute, in addition.
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

/// Allowed although it is inside a forbidden module: it never blocks.
const SHARED: &str = "std::sync::Arc";

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let mut found = Vec::new();
    for file in repository.rust_files.iter().filter(|file| file.path.starts_with("crates/")) {
        let is_lower = LOWER_CRATES.iter().any(|folder| file.path.starts_with(folder));
        for (path, line) in paths(file.shipped()) {
            let rules = FOR_LIBRARIES.iter().chain(FOR_LOWER_CRATES.iter().filter(|_| is_lower));
            let rules = rules.filter(|(forbidden, _)| is_below(&path, forbidden) && !is_below(&path, SHARED));
            let message = |forbidden, reason| format!("uses {forbidden}: {reason}");
            found.extend(rules.map(|(item, reason)| Violation::new(&file.path, line, message(item, reason))));
        }
    }
    found
}

/// Returns true if `path` is `forbidden` or something inside it.
fn is_below(path: &str, forbidden: &str) -> bool {
    path.strip_prefix(forbidden).is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
}
