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
    let is_library = |file: &&RustFile| file.is_shipped() && file.path.starts_with("crates/");
    for file in repository.rust_files.iter().filter(is_library) {
        let folder = file.path.split_once("/src/").map(|(folder, _)| folder);
        crates.entry(folder.unwrap_or_default()).or_default().push(file);
    }
    let mut found = Vec::new();
    for (folder, files) in crates {
        let circles = circles(&uses(&files)).into_iter().map(|modules| modules.join(", "));
        let message = |modules| format!("these modules use each other in a circle: {modules}");
        found.extend(circles.map(|modules| Violation::new(folder, 0, message(modules))));
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
    let inner = || files.iter().filter_map(|file| Some((*modules(file).first()?, *file)));
    // a module, or a type by which the root exports a module
    let mut owners: BTreeMap<&str, &str> =
        inner().flat_map(|(top, file)| types(file).map(move |(name, _)| (name, top))).collect();
    owners.extend(inner().map(|(top, _)| (top, top)));
    let mut uses = Uses::new();
    for (top, file) in inner() {
        let others = uses.entry(top.to_string()).or_default();
        for (path, _) in paths(file.shipped()) {
            let used = used_module(&path, modules(file).len()).and_then(|name| owners.get(name));
            others.extend(used.filter(|other| **other != top).map(|other| other.to_string()));
        }
    }
    uses
}

/// Name of a path directly below the root, from a file `depth` modules below it: a module, or a
/// type that the root exports.
fn used_module(path: &str, depth: usize) -> Option<&str> {
    let above = path.split("::").take_while(|part| *part == "super").count();
    match path.strip_prefix("crate::") {
        Some(below) => below.split("::").next(),
        None => path.split("::").nth(above).filter(|_| above == depth),
    }
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
