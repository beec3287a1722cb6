//! The example stories, run by the tests of the command.

use std::path::Path;

use super::{Outcome, execute};
use crate::repository::is_test_item;

const TESTS: &str = "apps/cli/tests/stories.rs";

pub(super) fn run(root: &Path) -> Outcome {
    // By the whole workspace, so that the dependencies built for the other tests serve again.
    execute(root, "cargo", &["test", "--workspace", "--test", "stories"])
}

/// The names of the tests that run the stories.
pub(super) fn names(root: &Path) -> Vec<String> {
    std::fs::read_to_string(root.join(TESTS)).map(|text| test_names(&text)).unwrap_or_default()
}

fn test_names(text: &str) -> Vec<String> {
    let items = syn::parse_file(text).map(|file| file.items).unwrap_or_default();
    let tests = items.into_iter().filter_map(|item| match item {
        syn::Item::Fn(function) if is_test_item(&function.attrs) => Some(function.sig.ident.to_string()),
        _ => None,
    });
    tests.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_tests_are_named() {
        assert_eq!(test_names("#[test] fn stories() {} fn other() {}"), ["stories"]);
    }
}
