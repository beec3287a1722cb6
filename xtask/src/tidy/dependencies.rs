//! Who may depend on whom.
//!
//! ```text
//! dynamics <- quantity <- hydraulics <- machine, project <-+
//! dynamics <- qft <----------------------------------------+- engineering <-+
//! quantity, qft <- figure <-------------------------------------------------+- workbench <- cli
//! ```

use std::collections::BTreeSet;

use super::Violation;
use crate::repository::Repository;

/// The packages by their folder, those outside the workspace too, and those of ours that each may
/// use.
const ALLOWED: &[(&str, &[&str])] = &[
    ("crates/dynamics", &[]),
    ("crates/hydraulics", &["phea-dynamics", "phea-quantity"]),
    ("crates/qft", &["phea-dynamics"]),
    ("crates/machine", &["phea-dynamics", "phea-hydraulics"]),
    ("crates/quantity", &["phea-dynamics"]),
    ("crates/figure", &["phea-dynamics", "phea-qft", "phea-quantity"]),
    ("crates/project", &["phea-dynamics", "phea-hydraulics", "phea-quantity"]),
    (
        "crates/engineering",
        &["phea-dynamics", "phea-hydraulics", "phea-machine", "phea-project", "phea-qft", "phea-quantity"],
    ),
    (
        "crates/workbench",
        &[
            "phea-dynamics",
            "phea-engineering",
            "phea-figure",
            "phea-hydraulics",
            "phea-machine",
            "phea-project",
            "phea-qft",
            "phea-quantity",
        ],
    ),
    ("apps/cli", &["phea-workbench"]),
    ("fuzz", &["phea-workbench"]),
    (
        "benches/peers/sundials",
        &["phea-dynamics", "phea-engineering", "phea-hydraulics", "phea-machine", "phea-project"],
    ),
    ("xtask", &[]),
];

/// The folders of the crates that compute and do nothing else.
pub(super) const LOWER_CRATES: [&str; 5] =
    ["crates/dynamics/", "crates/hydraulics/", "crates/machine/", "crates/qft/", "crates/quantity/"];

/// What a crate that only computes has no use for: files formats, clocks, threads, unseeded random
/// numbers.
const FOREIGN_TO_LOWER_CRATES: [&str; 10] =
    ["serde", "serde_json", "toml", "clap", "rand", "getrandom", "rayon", "chrono", "time", "tempfile"];

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let manifests = repository.texts(|path| path != "Cargo.toml" && path.ends_with("/Cargo.toml"));
    manifests.flat_map(|(path, text)| check_manifest(path, text)).collect()
}

fn check_manifest(path: &str, text: &str) -> Vec<Violation> {
    let folder = path.trim_end_matches("/Cargo.toml");
    let manifest: toml::Table = match text.parse() {
        Ok(manifest) => manifest,
        Err(error) => return vec![Violation::new(path, 0, error.to_string())],
    };
    let Some((_, allowed)) = ALLOWED.iter().find(|(known, _)| *known == folder) else {
        let message =
            "a package that the table of allowed dependencies does not know (xtask/src/tidy/dependencies.rs)";
        return vec![Violation::new(path, 0, message)];
    };
    let lower = LOWER_CRATES.contains(&format!("{folder}/").as_str());
    let forbidden = |name: &str| {
        (name.starts_with("phea-") && !allowed.contains(&name))
            || (lower && FOREIGN_TO_LOWER_CRATES.contains(&name))
    };
    let mut used = BTreeSet::new();
    collect_dependencies(&manifest, &mut used);
    let found = used.into_iter().filter(|name| forbidden(name));
    found
        .map(|name| Violation::new(path, line_of(text, &name), format!("may not depend on {name}")))
        .collect()
}

/// The packages named in `[dependencies]`, `[dev-dependencies]`, `[build-dependencies]`, also below
/// `[target]`.
fn collect_dependencies(table: &toml::Table, used: &mut BTreeSet<String>) {
    for (key, value) in table {
        let Some(inner) = value.as_table() else { continue };
        match key.as_str() {
            "dependencies" | "dev-dependencies" | "build-dependencies" => {
                for (name, what) in inner {
                    let package = what.get("package").and_then(toml::Value::as_str);
                    used.insert(package.unwrap_or(name).to_string());
                }
            }
            "target" => {
                inner.values().filter_map(toml::Value::as_table).for_each(|t| collect_dependencies(t, used))
            }
            _ => {}
        }
    }
}

fn line_of(text: &str, name: &str) -> usize {
    text.lines().position(|line| line.contains(name)).map_or(0, |index| index + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn messages(path: &str, text: &str) -> Vec<String> {
        check(&Repository::from_texts(&[(path, text)])).iter().map(Violation::to_string).collect()
    }

    #[test]
    fn qft_and_hydraulics_never_use_each_other() {
        assert_eq!(
            messages("crates/qft/Cargo.toml", "[dependencies]\nphea-hydraulics = { workspace = true }"),
            ["crates/qft/Cargo.toml:2: may not depend on phea-hydraulics"]
        );
        assert_eq!(
            messages("crates/hydraulics/Cargo.toml", "[dev-dependencies]\nphea-qft.workspace = true").len(),
            1
        );
    }

    #[test]
    fn shells_use_the_workbench_only() {
        assert_eq!(
            messages("apps/cli/Cargo.toml", "[dependencies]\nphea-dynamics.workspace = true").len(),
            1
        );
        assert!(
            messages("apps/cli/Cargo.toml", "[dependencies]\nphea-workbench.workspace = true").is_empty()
        );
    }

    #[test]
    fn renaming_and_targets_hide_nothing() {
        let renamed = "[target.'cfg(unix)'.dependencies]\nq = { package = \"phea-qft\", path = \"../qft\" }";
        assert_eq!(messages("crates/hydraulics/Cargo.toml", renamed).len(), 1);
    }

    #[test]
    fn lower_crates_know_no_file_format_and_no_chance() {
        for name in ["serde", "rand"] {
            let text = format!("[dependencies]\n{name} = \"1\"");
            assert_eq!(messages("crates/dynamics/Cargo.toml", &text).len(), 1);
            assert!(messages("crates/workbench/Cargo.toml", &text).is_empty());
        }
    }

    #[test]
    fn a_new_package_must_be_placed() {
        assert_eq!(messages("crates/extra/Cargo.toml", "[dependencies]").len(), 1);
    }
}
