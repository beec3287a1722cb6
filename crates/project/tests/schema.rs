//! The schema that lies in the book is that of the code; `comparisons/compare_schema.py` holds it
//! against the reader.
#![allow(clippy::expect_used, reason = "helpers of tests may fail the test")]

use std::collections::BTreeSet;
use std::path::Path;

use phea_project::{keys, schema};
use serde_json::Value;

#[test]
fn the_schema_beside_the_book_is_what_the_command_prints() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../book/src/phea.schema.json");
    let committed = std::fs::read_to_string(path).expect("the schema is committed");
    let same = committed == format!("{:#}\n", schema());
    assert!(same, "write it anew: cargo run -p phea-cli -- schema --out book/src");
}

/// Every key below a schema, by name.
fn names(schema: &Value, found: &mut BTreeSet<String>) {
    match schema {
        Value::Object(members) => {
            if let Some(Value::Object(properties)) = members.get("properties") {
                found.extend(properties.keys().cloned());
            }
            members.values().for_each(|value| names(value, found));
        }
        Value::Array(items) => items.iter().for_each(|item| names(item, found)),
        _ => {}
    }
}

#[test]
fn every_key_that_is_listed_is_in_the_schema_with_what_it_means() {
    let mut found = BTreeSet::new();
    names(&schema(), &mut found);
    for entry in keys().iter().filter(|entry| entry.key.name != "NAME") {
        assert!(found.contains(entry.key.name), "{}", entry.path);
    }
    assert!(found.len() > 200, "{}", found.len());
}
