//! The top-level modules of a crate do not use each other in a circle: a reader begins with those
//! that use no other.

use std::collections::{BTreeMap, BTreeSet};

use super::Violation;
use crate::repository::{Repository, RustFile};

/// For each top-level module those that it uses.
type Uses = BTreeMap<String, BTreeSet<String>>;

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let mut crates: BTreeMap<&str, Vec<&RustFile>> = BTreeMap::new();
    for file in repository.rust_files().iter().filter(|file| !file.is_test_file()) {
        let folder = file.path.split_once("/src/").map(|(folder, _)| folder);
        if let Some(folder) = folder.filter(|folder| folder.starts_with("crates/")) {
            crates.entry(folder).or_default().push(file);
        }
    }
    crates.iter().flat_map(|(folder, files)| check_crate(folder, files)).collect()
}

fn check_crate(folder: &str, files: &[&RustFile]) -> Vec<Violation> {
    let told = |circle: &Vec<String>| {
        Violation::new(folder, 0, format!("these modules use each other in a circle: {}", circle.join(", ")))
    };
    circles(&uses(files)).iter().map(told).collect()
}

/// The modules from the root of the crate to a file, the root's own file having none.
fn modules(path: &str) -> Vec<&str> {
    let inner = path.split_once("/src/").map_or(path, |(_, inner)| inner).trim_end_matches(".rs");
    if matches!(inner, "lib" | "main") { vec![] } else { inner.split('/').collect() }
}

fn uses(files: &[&RustFile]) -> Uses {
    let rooms: BTreeSet<&str> =
        files.iter().filter_map(|file| modules(&file.path).first().copied()).collect();
    let mut owners: BTreeMap<String, &str> = BTreeMap::new();
    for file in files {
        if let Some(&room) = modules(&file.path).first() {
            owners.extend(super::names::types(&file.syntax).into_iter().map(|(name, _)| (name, room)));
        }
    }
    let mut uses = Uses::new();
    for file in files {
        let own = modules(&file.path);
        let Some(&room) = own.first() else { continue };
        let paths = file.shipped().paths;
        let used = paths.iter().filter_map(|(path, _)| used_room(path, own.len(), &rooms, &owners));
        uses.entry(room.to_string())
            .or_default()
            .extend(used.filter(|other| *other != room).map(String::from));
    }
    uses
}

/// The top-level module that a path leads to from a file that lies `depth` modules below the root:
/// by its name, or where the root passes a type on, by that type.
fn used_room<'a>(
    path: &'a str,
    depth: usize,
    rooms: &BTreeSet<&str>,
    owners: &BTreeMap<String, &'a str>,
) -> Option<&'a str> {
    let parts: Vec<&str> = path.split("::").collect();
    let above = parts.iter().take_while(|part| **part == "super").count();
    let rest = match parts.first() {
        Some(&"crate") => &parts[1..],
        Some(&"super") if above == depth => &parts[above..],
        _ => return None,
    };
    let first = *rest.first()?;
    rooms.contains(first).then_some(first).or_else(|| owners.get(first).copied())
}

/// Modules that reach themselves through others, together with those.
fn circles(uses: &Uses) -> Vec<Vec<String>> {
    let reached: Uses = uses.keys().map(|room| (room.clone(), reached(uses, room))).collect();
    let mut circles: Vec<Vec<String>> = Vec::new();
    for (room, others) in &reached {
        let back = |other: &&String| reached.get(*other).is_some_and(|others| others.contains(room));
        let circle: Vec<String> = others.iter().filter(back).cloned().collect();
        if circle.len() > 1 && !circles.contains(&circle) {
            circles.push(circle);
        }
    }
    circles
}

fn reached(uses: &Uses, from: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut open = vec![from.to_string()];
    while let Some(room) = open.pop() {
        for other in uses.get(&room).into_iter().flatten() {
            if found.insert(other.clone()) {
                open.push(other.clone());
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(files: &[(&str, &str)]) -> Vec<String> {
        check(&Repository::from_texts(files)).iter().map(|violation| violation.message.clone()).collect()
    }

    #[test]
    fn a_circle_is_found_through_folders_super_and_what_the_root_passes_on() {
        let files = [
            ("crates/x/src/a.rs", "use crate::b::B;"),
            ("crates/x/src/b/deep.rs", "use super::super::c::f;"),
            ("crates/x/src/b.rs", "pub struct B;"),
            ("crates/x/src/c.rs", "use super::A;"),
            ("crates/x/src/a/own.rs", "pub struct A;"),
            ("crates/x/src/d.rs", "use crate::a::A;"),
        ];
        assert_eq!(found(&files), ["these modules use each other in a circle: a, b, c"]);
    }

    #[test]
    fn what_only_tests_use_and_what_lies_within_a_module_is_no_circle() {
        let files = [
            ("crates/x/src/a.rs", "use crate::b::B; use super::b;"),
            ("crates/x/src/b.rs", "#[cfg(test)] mod tests { use crate::a::A; }"),
            ("crates/x/src/b/one.rs", "use super::two::Two;"),
            ("crates/x/src/b/two.rs", "use super::one::One;"),
            ("crates/x/src/one.rs", "use crate::a;"),
        ];
        assert_eq!(found(&files), [""; 0]);
    }
}
