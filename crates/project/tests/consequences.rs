//! A value that is refused is the one error: nothing is said of what would follow from it.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::unwrap_used,
    reason = "helpers of tests may fail the test"
)]

use std::path::Path;

use phea_project::source::Memory;
use phea_project::{self as project, Severity};

/// Every project of the corpus of valid ones, and the examples.
fn projects() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = Vec::new();
    for folder in ["tests/valid", "../../examples/ybitu"] {
        for file in std::fs::read_dir(root.join(folder)).unwrap() {
            let path = file.unwrap().path();
            if path.extension().is_some_and(|extension| extension == "toml") {
                found.push((path.display().to_string(), std::fs::read_to_string(&path).unwrap()));
            }
        }
    }
    found
}

#[test]
fn a_refused_number_is_the_only_error() {
    let mut wrong = Vec::new();
    let mut count = 0;
    for (name, text) in projects() {
        let source = Memory::default().with("p.toml", text);
        let Ok(loaded) = project::read(&source, "p.toml", &[], &[]) else { continue };
        for (path, (_, value)) in loaded.project.listed_numbers() {
            let path = path.replace('[', ".").replace(']', "");
            // a setting makes a table of its own where a side inherits one
            let is_declared =
                |value: f64| project::read(&source, "p.toml", &[format!("{path}={value:e}")], &[]).is_ok();
            if !value.is_some_and(is_declared) {
                continue;
            }
            let setting = format!("{path}=1 nonsense");
            let Err(refusal) = project::read(&source, "p.toml", &[setting], &[]) else { continue };
            let errors: Vec<_> =
                refusal.diagnostics.iter().filter(|one| one.severity == Severity::Error).collect();
            count += 1;
            for other in errors.iter().filter(|error| !error.file.starts_with("--set")) {
                wrong.push(format!("{name}: {path}: {}:{} {}", other.file, other.line, other.message));
            }
        }
    }
    assert!(count > 500, "{count}");
    assert!(wrong.is_empty(), "{} of {count}\n{}", wrong.len(), wrong.join("\n"));
}
