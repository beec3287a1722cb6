//! Every malformed project of the corpus is rejected with the messages and places stated in its
//! `.expect` file.
//!
//! `NAME.expect` has one line for each finding, in order: severity, line, column and message, and
//! below it, indented, the help if there is one.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::unwrap_used,
    reason = "helpers of tests may fail the test"
)]

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use phea_project::source::Memory;
use phea_project::{self as project, Severity};

fn corpus() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/malformed");
    let files = std::fs::read_dir(folder).expect("the corpus is there");
    let mut files: Vec<PathBuf> = files.map(|file| file.expect("a file").path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "toml"));
    files.sort();
    files
}

/// Findings in a file, in the form of the expectations, and a flag for its rejection.
fn findings(bytes: &[u8]) -> (String, bool) {
    let source = Memory::default().with("project.toml", bytes);
    let (diagnostics, refused) = match project::read(&source, "project.toml", &[], &[]) {
        Ok(loaded) => (loaded.warnings, false),
        Err(report) => (report.diagnostics, true),
    };
    let mut text = String::new();
    for found in diagnostics {
        let severity = if found.severity == Severity::Error { "error" } else { "warning" };
        writeln!(text, "{severity} {}:{} {}", found.line, found.column, found.message).expect("memory");
        if let Some(help) = found.help {
            writeln!(text, "    {help}").expect("memory");
        }
    }
    (text, refused)
}

#[test]
fn every_malformed_project_has_its_expected_error() {
    let files = corpus();
    assert!(files.len() >= 60, "{} files", files.len());
    let mut wrong = String::new();
    for file in files {
        let (found, refused) = findings(&std::fs::read(&file).expect("readable"));
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let expected = std::fs::read_to_string(file.with_extension("expect")).unwrap_or_default();
        if found != expected || !refused {
            writeln!(wrong, "== {name}{}\n{found}", if refused { "" } else { " (accepted)" })
                .expect("memory");
        }
    }
    assert!(wrong.is_empty(), "differs from what is expected; found:\n{wrong}");
}
