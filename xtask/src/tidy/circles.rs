//! Cycles between the top-level modules of a crate are forbidden, so that a reader can begin with
//! those that use no other. Types of the libraries and applications have unique names.

use std::collections::{BTreeMap, BTreeSet};

use super::Violation;
use crate::repository::Repository;
use crate::rust_file::{RustFile, paths, words};

/// Modules that each top-level module uses.
type Uses = BTreeMap<String, BTreeSet<String>>;

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let mut crates: BTreeMap<&str, Vec<&RustFile>> = BTreeMap::new();
    for file in repository.rust_files.iter().filter(|file| file.is_shipped()) {
        if let Some((folder, _)) = file.path.split_once("/src/").filter(|_| file.path.starts_with("crates/"))
        {
            crates.entry(folder).or_default().push(file);
        }
    }
    let mut found = Vec::new();
    for (folder, files) in crates {
        for circle in circles(&uses(&files)) {
            let message = format!("these modules use each other in a circle: {}", circle.join(", "));
            found.push(Violation::new(folder, 0, message));
        }
    }
    found
}

/// Types for which another file has one of equal name.
pub(super) fn check_names(repository: &Repository) -> Vec<Violation> {
    let mut places: BTreeMap<&str, &str> = BTreeMap::new();
    let mut found = Vec::new();
    for file in repository.rust_files.iter().filter(|file| file.is_shipped() && file.path.contains("/src/")) {
        for (name, line) in types(file) {
            if let Some(other) = places.insert(name, &file.path) {
                let message = format!("`{name}` is a type of {other} too: one name, one thing");
                found.push(Violation::new(&file.path, line, message));
            }
        }
    }
    found
}

/// The types that a file defines, with their lines; types in implementations and traits belong to
/// these.
fn types(file: &RustFile) -> impl Iterator<Item = (&str, usize)> {
    file.shipped().filter_map(|line| {
        let mut words = words(&line.code).filter(|word| !["pub", "crate", "super"].contains(word));
        let is_type = match words.next()? {
            "struct" | "enum" | "trait" => true,
            "type" => !line.code.starts_with(' '),
            _ => false,
        };
        Some((words.next().filter(|_| is_type)?, line.number))
    })
}

/// The modules from the root of the crate to a file; the root's own file has none.
fn modules(file: &RustFile) -> Vec<&str> {
    let inner = file.path.split_once("/src/").map_or("", |(_, inner)| inner).trim_end_matches(".rs");
    if matches!(inner, "lib" | "main") { vec![] } else { inner.split('/').collect() }
}

fn uses(files: &[&RustFile]) -> Uses {
    let tops: BTreeSet<&str> = files.iter().filter_map(|file| modules(file).first().copied()).collect();
    let mut owners: BTreeMap<&str, &str> = BTreeMap::new();
    for file in files {
        if let Some(&top) = modules(file).first() {
            owners.extend(types(file).map(|(name, _)| (name, top)));
        }
    }
    let mut uses = Uses::new();
    for file in files {
        let own = modules(file);
        let Some(&top) = own.first() else { continue };
        for (path, _) in paths(file.shipped()) {
            let used = used_module(&path, own.len())
                .and_then(|first| tops.get(first).copied().or_else(|| owners.get(first).copied()));
            let others = uses.entry(top.to_string()).or_default();
            others.extend(used.filter(|other| *other != top).map(String::from));
        }
    }
    uses
}

/// Name of a path directly below the root, from a file `depth` modules below it: a module, or a
/// type that the root exports.
fn used_module(path: &str, depth: usize) -> Option<&str> {
    let mut parts = path.split("::").peekable();
    let first = *parts.peek()?;
    let mut above = 0;
    while parts.next_if(|part| *part == "super").is_some() {
        above += 1;
    }
    let is_root = first == "crate" || above == depth;
    if first == "crate" {
        parts.next();
    }
    parts.next().filter(|_| is_root)
}

/// Modules that reach themselves through others, together with those.
fn circles(uses: &Uses) -> BTreeSet<Vec<String>> {
    let reached: Uses = uses.keys().map(|module| (module.clone(), reached(uses, module))).collect();
    let circle = |(module, others): (&String, &BTreeSet<String>)| -> Vec<String> {
        let back = |other: &&String| reached.get(*other).is_some_and(|others| others.contains(module));
        others.iter().filter(back).cloned().collect()
    };
    reached.iter().map(circle).filter(|circle| circle.len() > 1).collect()
}

fn reached(uses: &Uses, from: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut open = vec![from];
    while let Some(module) = open.pop() {
        for other in uses.get(module).into_iter().flatten() {
            if found.insert(other.clone()) {
                open.push(other);
            }
        }
    }
    found
}
