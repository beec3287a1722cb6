//! Schema and guide in the book have the keys of the code; `comparisons/compare_schema.py` compares
//! the schema with the reader.
#![allow(clippy::expect_used, reason = "helpers of tests may fail the test")]

use std::collections::BTreeSet;
use std::path::Path;

use phea_project::{keys, schema};
use serde_json::Value;

#[test]
fn the_schema_in_the_book_is_printed_by_the_command() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../book/src/phea.schema.json");
    let committed = std::fs::read_to_string(path).expect("the schema is committed");
    let same = committed == format!("{:#}\n", schema());
    assert!(same, "write it anew: cargo run -p phea-cli -- schema --out book/src");
}

/// Adds the keys below a schema, by name, and the words of every choice; without the names of
/// signals, which are columns of the simulation's table.
fn names(schema: &Value, found: &mut BTreeSet<String>) {
    match schema {
        Value::Object(members) => {
            if let Some(Value::Object(properties)) = members.get("properties") {
                found.extend(properties.keys().cloned());
            }
            if let Some(Value::Array(words)) = members.get("enum") {
                found.extend(words.iter().filter_map(Value::as_str).map(str::to_string));
            }
            let others = members.iter().filter(|(name, _)| *name != "signal");
            others.for_each(|(_, value)| names(value, found));
        }
        Value::Array(items) => items.iter().for_each(|item| names(item, found)),
        _ => {}
    }
}

#[test]
fn every_listed_key_is_in_the_schema_with_its_meaning() {
    let mut found = BTreeSet::new();
    names(&schema(), &mut found);
    for entry in keys().iter().filter(|entry| entry.key.name != "NAME") {
        assert!(found.contains(entry.key.name), "{}", entry.path);
    }
    assert!(found.len() > 200, "{}", found.len());
}

/// Code spans of a line, `[table]` as `table`.
fn spans(line: &str) -> impl Iterator<Item = &str> {
    line.split('`').skip(1).step_by(2).map(|span| span.trim_matches(['[', ']']))
}

#[test]
fn the_guide_has_every_key() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../book/src/guide/project_file.md");
    let guide = std::fs::read_to_string(path).expect("the guide is committed");
    let mut known = BTreeSet::new();
    names(&schema(), &mut known);
    let described: BTreeSet<&str> = guide.lines().flat_map(spans).collect();
    let missing: Vec<&String> = known.iter().filter(|name| !described.contains(name.as_str())).collect();
    assert!(missing.is_empty(), "not in the guide: {missing:?}");
    let mut is_table_of_keys = false;
    for line in guide.lines() {
        is_table_of_keys = line.starts_with("| key |") || (is_table_of_keys && line.starts_with('|'));
        let keys = line.split('|').nth(1).filter(|_| is_table_of_keys);
        for key in keys.into_iter().flat_map(spans) {
            assert!(known.contains(key), "no key of a project: {line}");
        }
    }
}
