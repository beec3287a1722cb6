//! One lint table for all packages, and no lint silenced without a reason.

use syn::visit::{self, Visit};

use super::Violation;
use crate::repository::{Repository, RustFile, is_test_item};

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let manifests = repository.texts(|path| path != "Cargo.toml" && path.ends_with("/Cargo.toml"));
    let mut found: Vec<Violation> = manifests.filter_map(|(path, text)| check_manifest(path, text)).collect();
    found.extend(repository.rust_files().iter().flat_map(check_file));
    found
}

/// The package that calls a library in C, which cannot forbid what is not safe Rust.
const CALLS_C: &str = "benches/peers/sundials/Cargo.toml";

fn check_manifest(path: &str, text: &str) -> Option<Violation> {
    let manifest: toml::Table = text.parse().ok()?;
    if manifest.contains_key("workspace") || path == CALLS_C {
        // A workspace of its own, as fuzzing tools want it, has nothing to inherit.
        return None;
    }
    let lints = manifest.get("lints").and_then(|lints| lints.get("workspace")).and_then(toml::Value::as_bool);
    (lints != Some(true)).then(|| Violation::new(path, 0, "lacks `[lints] workspace = true`"))
}

fn check_file(file: &RustFile) -> Vec<Violation> {
    let mut silenced = SilencedLints::default();
    if !file.is_test_file() {
        silenced.visit_file(&file.syntax);
    }
    let message = "silences a lint without `reason = \"...\"`";
    silenced.lines.into_iter().map(|line| Violation::new(&file.path, line, message)).collect()
}

#[derive(Default)]
struct SilencedLints {
    lines: Vec<usize>,
}

impl<'ast> Visit<'ast> for SilencedLints {
    fn visit_item_mod(&mut self, module: &'ast syn::ItemMod) {
        if !is_test_item(&module.attrs) {
            visit::visit_item_mod(self, module);
        }
    }

    fn visit_attribute(&mut self, attribute: &'ast syn::Attribute) {
        let syn::Meta::List(list) = &attribute.meta else { return };
        let silences = list.path.is_ident("allow") || list.path.is_ident("expect");
        if silences && !list.tokens.to_string().contains("reason =") {
            self.lines.push(attribute.pound_token.span.start().line);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(path: &str, text: &str) -> usize {
        check(&Repository::from_texts(&[(path, text)])).len()
    }

    #[test]
    fn every_package_takes_the_table_of_the_workspace() {
        assert_eq!(count("crates/a/Cargo.toml", "[package]\nname = \"a\""), 1);
        assert_eq!(count("crates/a/Cargo.toml", "[lints]\nworkspace = false"), 1);
        assert_eq!(count("crates/a/Cargo.toml", "[lints]\nworkspace = true"), 0);
        assert_eq!(count("fuzz/Cargo.toml", "[package]\nname = \"fuzz\"\n[workspace]"), 0);
    }

    #[test]
    fn silence_needs_a_reason() {
        let path = "crates/a/src/lib.rs";
        assert_eq!(count(path, "#[allow(clippy::unwrap_used)] fn f() {}"), 1);
        assert_eq!(count(path, "#![expect(dead_code)]"), 1);
        assert_eq!(count(path, "fn f() { #[allow(clippy::panic)] { panic!() } }"), 1);
        assert_eq!(count(path, "#[allow(clippy::unwrap_used, reason = \"checked above\")] fn f() {}"), 0);
    }

    #[test]
    fn tests_may_be_silent() {
        assert_eq!(
            count("crates/a/src/lib.rs", "#[cfg(test)] mod tests { #[allow(dead_code)] fn f() {} }"),
            0
        );
        assert_eq!(count("crates/a/tests/golden.rs", "#![allow(dead_code)]"), 0);
    }
}
