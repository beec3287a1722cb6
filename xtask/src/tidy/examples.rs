//! What other programs may call is shown at work: a file with a public free function has an example
//! with an assertion, in the crates that compute. Those above are called through the commands.

use syn::visit::{self, Visit};

use super::Violation;
use crate::repository::{Repository, RustFile, is_test_item};

const CRATES: [&str; 5] = ["quantity", "dynamics", "hydraulics", "machine", "qft"];
const ASSERTIONS: [&str; 3] = ["assert!(", "assert_eq!(", "assert_ne!("];

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    repository.rust_files().iter().filter(|file| is_asked(file)).filter_map(check_file).collect()
}

fn is_asked(file: &RustFile) -> bool {
    let holds = |name: &str| file.path.starts_with(&format!("crates/{name}/src/"));
    CRATES.iter().any(|name| holds(name)) && !file.is_test_file()
}

fn check_file(file: &RustFile) -> Option<Violation> {
    let name = &file.syntax.items.iter().find_map(public_function)?.sig.ident;
    let mut documentation = Documentation::default();
    documentation.visit_file(&file.syntax);
    (!has_example(&documentation.text)).then(|| {
        let message = format!("`{name}` is public, but no example of this file asserts anything");
        Violation::new(&file.path, name.span().start().line, message)
    })
}

/// A function at the level of the file that is `pub`: where its module is private and nothing
/// exports it, the compiler asks for `pub(crate)`.
fn public_function(item: &syn::Item) -> Option<&syn::ItemFn> {
    match item {
        syn::Item::Fn(function)
            if matches!(function.vis, syn::Visibility::Public(_)) && !is_test_item(&function.attrs) =>
        {
            Some(function)
        }
        _ => None,
    }
}

/// All documentation of a file, tests left out.
#[derive(Default)]
struct Documentation {
    text: String,
}

impl<'ast> Visit<'ast> for Documentation {
    fn visit_item_mod(&mut self, module: &'ast syn::ItemMod) {
        if !is_test_item(&module.attrs) {
            visit::visit_item_mod(self, module);
        }
    }

    fn visit_meta_name_value(&mut self, meta: &'ast syn::MetaNameValue) {
        let syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(line), .. }) = &meta.value else { return };
        if meta.path.is_ident("doc") {
            self.text.push_str(&line.value());
            self.text.push('\n');
        }
    }
}

/// Whether a fence that is run as a test asserts something. One with any word behind its mark but
/// `rust` is another language, or is not run.
fn has_example(documentation: &str) -> bool {
    let mut fence = None;
    for line in documentation.lines().map(str::trim) {
        match (line.strip_prefix("```"), fence) {
            (Some(language), None) => fence = Some(matches!(language.trim(), "" | "rust")),
            (Some(_), Some(_)) => fence = None,
            (None, Some(true)) if ASSERTIONS.iter().any(|assertion| line.contains(assertion)) => return true,
            _ => {}
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    const PATH: &str = "crates/qft/src/bound.rs";

    fn found(path: &str, text: &str) -> Vec<String> {
        check(&Repository::from_texts(&[(path, text)])).iter().map(Violation::to_string).collect()
    }

    #[test]
    fn a_public_function_without_an_example_is_reported_at_its_name() {
        assert_eq!(
            found(PATH, "/// Bare.\npub fn bound() {}"),
            ["crates/qft/src/bound.rs:2: `bound` is public, but no example of this file asserts anything"]
        );
    }

    #[test]
    fn an_example_anywhere_in_the_file_is_enough() {
        for text in [
            "/// ```\n/// assert!(true);\n/// ```\npub fn bound() {}",
            "//! ```rust\n//! assert_eq!(1, 1);\n//! ```\npub fn bound() {}",
            "pub fn bound() {}\nimpl A {\n    /// ```\n    /// assert_ne!(1, 2);\n    /// ```\n    fn a() {}\n}",
        ] {
            assert!(found(PATH, text).is_empty(), "{text}");
        }
    }

    #[test]
    fn what_is_not_run_and_what_asserts_nothing_is_no_example() {
        for documentation in [
            "/// ```ignore\n/// assert!(true);\n/// ```\n",
            "/// ```no_run\n/// assert!(true);\n/// ```\n",
            "/// ```text\n/// assert!(true);\n/// ```\n",
            "/// ```\n/// bound();\n/// ```\n/// assert!(true);\n",
            "#[cfg(test)]\nmod tests {\n    /// ```\n    /// assert!(true);\n    /// ```\n    fn a() {}\n}\n",
        ] {
            assert_eq!(
                found(PATH, &format!("{documentation}pub fn bound() {{}}")).len(),
                1,
                "{documentation}"
            );
        }
    }

    #[test]
    fn functions_for_the_crate_alone_methods_and_crates_above_need_none() {
        for text in ["pub(crate) fn bound() {}", "fn bound() {}", "impl A {\n    pub fn bound() {}\n}"] {
            assert!(found(PATH, text).is_empty(), "{text}");
        }
        assert!(found("crates/engineering/src/audit.rs", "pub fn audit() {}").is_empty());
        assert!(found("crates/qft/tests/all.rs", "pub fn audit() {}").is_empty());
    }
}
