//! Dependencies between packages: only those that the table below allows. The code map of
//! ARCHITECTURE.md draws them.

use super::Violation;
use crate::repository::Repository;

/// Packages by their folder, including those outside the workspace, and the packages of this
/// repository that each may use.
const ALLOWED: &[(&str, &str)] = &[
    ("crates/derive", ""),
    ("crates/dynamics", ""),
    ("crates/hydraulics", "dynamics quantity table"),
    ("crates/qft", "dynamics"),
    ("crates/machine", "dynamics hydraulics"),
    ("crates/quantity", "dynamics"),
    ("crates/figure", "dynamics qft quantity"),
    ("crates/table", "dynamics quantity"),
    ("crates/project", "dynamics hydraulics quantity table"),
    ("crates/engineering", "dynamics hydraulics machine project qft quantity"),
    ("crates/workbench", "derive dynamics engineering figure hydraulics machine project qft quantity"),
    ("apps/cli", "files workbench"),
    ("apps/files", "workbench"),
    ("apps/python", "cli files workbench"),
    ("fuzz", "workbench"),
    ("benches/peers/sundials", "dynamics engineering hydraulics machine project"),
    ("xtask", ""),
];

/// The folders of the crates that only compute.
pub(super) const LOWER_CRATES: [&str; 5] =
    ["crates/dynamics/", "crates/hydraulics/", "crates/machine/", "crates/qft/", "crates/quantity/"];

/// Packages that a crate that only computes does not need: file formats, clocks, threads, unseeded
/// random numbers.
const FOREIGN_TO_LOWER_CRATES: [&str; 10] =
    ["serde", "serde_json", "toml", "clap", "rand", "getrandom", "rayon", "chrono", "time", "tempfile"];

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    repository.texts("", "/Cargo.toml").flat_map(|(path, text)| check_manifest(path, text)).collect()
}

fn check_manifest(path: &str, text: &str) -> Vec<Violation> {
    let manifest: toml::Table = match text.parse() {
        Ok(manifest) => manifest,
        Err(error) => return vec![Violation::new(path, 0, error.to_string())],
    };
    let folder = path.trim_end_matches("/Cargo.toml");
    let Some((_, allowed)) = ALLOWED.iter().find(|(known, _)| *known == folder) else {
        return vec![Violation::new(path, 0, "is missing in the table of xtask/src/tidy/dependencies.rs")];
    };
    let is_lower = LOWER_CRATES.contains(&format!("{folder}/").as_str());
    let is_forbidden = |name: &str| match name.strip_prefix("phea-") {
        Some(own) => allowed.split(' ').all(|one| one != own),
        None => is_lower && FOREIGN_TO_LOWER_CRATES.contains(&name),
    };
    let targets = manifest.get("target").and_then(toml::Value::as_table);
    let targets = targets.into_iter().flat_map(|targets| targets.values().filter_map(toml::Value::as_table));
    let used = [&manifest].into_iter().chain(targets).flat_map(dependencies);
    let message = |name| format!("may not depend on {name}");
    used.filter(|name| is_forbidden(name)).map(|name| Violation::new(path, 0, message(name))).collect()
}

/// The packages named in `[dependencies]`, `[dev-dependencies]`, `[build-dependencies]`.
fn dependencies(table: &toml::Table) -> impl Iterator<Item = &str> {
    let lists = ["dependencies", "dev-dependencies", "build-dependencies"];
    let lists = lists.into_iter().filter_map(|list| table.get(list).and_then(toml::Value::as_table));
    lists.flatten().map(|(name, details)| {
        let package = details.get("package").and_then(toml::Value::as_str);
        package.unwrap_or(name)
    })
}

/// The package that calls a library in C, which cannot forbid unsafe Rust.
const CALLS_C: &str = "benches/peers/sundials/Cargo.toml";

/// Checks that every package has the lints of the workspace; a package that is its own workspace,
/// as fuzzing tools require, has nothing to inherit.
pub(super) fn check_lints(repository: &Repository) -> Vec<Violation> {
    let manifests = repository.texts("", "/Cargo.toml").filter(|(path, text)| {
        let is_exempt = *path == CALLS_C || text.lines().any(|line| line.trim() == "[workspace]");
        !is_exempt && !text.contains("[lints]\nworkspace = true")
    });
    manifests.map(|(path, _)| Violation::new(path, 0, "lacks `[lints] workspace = true`")).collect()
}
