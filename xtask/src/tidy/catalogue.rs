//! Numbers in the built-in catalogue have a source, and every file of the catalogue is built in.
//!
//! A file in `crates/project/catalogue/` describes one product and has its name. `source` applies
//! to every key of the file, `[sources]` to single ones.

use super::Violation;
use crate::repository::Repository;

const BUILT_IN: &str = "crates/project/src/catalogue/built_in.rs";
const FOLDER: &str = "crates/project/catalogue/";

/// Keys that state no property of the product.
const HEAD: [&str; 7] = ["schema", "kind", "name", "title", "manufacturer", "source", "sources"];

/// A source shorter than this names no document.
const SHORTEST_SOURCE: usize = 12;

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let built_in = repository.text(BUILT_IN).unwrap_or_default();
    repository.texts(FOLDER, ".toml").flat_map(|(path, text)| check_file(path, text, built_in)).collect()
}

fn check_file(path: &str, text: &str, built_in: &str) -> Vec<Violation> {
    let table: toml::Table = match text.parse() {
        Ok(table) => table,
        Err(error) => return vec![Violation::new(path, 0, error.to_string())],
    };
    let mut found = Vec::new();
    if !built_in.contains(&path.replace(FOLDER, "catalogue/")) {
        found.push(Violation::new(path, 0, format!("has no line in {BUILT_IN}")));
    }
    let name = table.get("name").and_then(toml::Value::as_str).unwrap_or_default();
    if !path.ends_with(&format!("/{name}.toml")) {
        found.push(Violation::new(path, 0, format!("does not have the name of its product, `{name}`")));
    }
    let is_source = |value: &toml::Value| value.as_str().is_some_and(|text| text.len() >= SHORTEST_SOURCE);
    for key in table.keys().filter(|key| !HEAD.contains(&key.as_str())) {
        let own = table.get("sources").and_then(|sources| sources.get(key));
        if !own.or(table.get("source")).is_some_and(is_source) {
            let line = text.lines().position(|line| line.starts_with(key.as_str()));
            let number = line.map_or(0, |index| index + 1);
            found.push(Violation::new(path, number, format!("`{key}` has no source")));
        }
    }
    found
}
