//! One name, one thing: no type of the libraries and applications is called as another one is.

use std::collections::BTreeMap;

use proc_macro2::Span;
use syn::visit::{self, Visit};

use super::Violation;
use crate::repository::{Repository, is_test_item};

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let mut places: BTreeMap<String, Vec<(&str, usize)>> = BTreeMap::new();
    for file in repository.rust_files() {
        let shipped = file.path.starts_with("crates/") || file.path.starts_with("apps/");
        if !shipped || !file.path.contains("/src/") || file.is_test_file() {
            continue;
        }
        for (name, span) in types(&file.syntax) {
            places.entry(name).or_default().push((&file.path, span.start().line));
        }
    }
    let repeated = places.iter().flat_map(|(name, places)| {
        let (first, _) = places[0];
        places[1..].iter().map(move |(path, line)| {
            Violation::new(path, *line, format!("`{name}` is a type of {first} too: one name, one thing"))
        })
    });
    repeated.collect()
}

/// The types that a file defines, each with its place.
pub(super) fn types(syntax: &syn::File) -> Vec<(String, Span)> {
    let mut types = Types::default();
    types.visit_file(syntax);
    types.names
}

/// Types that a file defines outside of its tests; those of implementations and traits belong to
/// these.
#[derive(Default)]
struct Types {
    names: Vec<(String, Span)>,
}

impl<'ast> Visit<'ast> for Types {
    fn visit_item(&mut self, item: &'ast syn::Item) {
        let (name, attributes) = match item {
            syn::Item::Struct(item) => (Some(&item.ident), &item.attrs),
            syn::Item::Enum(item) => (Some(&item.ident), &item.attrs),
            syn::Item::Trait(item) => (Some(&item.ident), &item.attrs),
            syn::Item::Type(item) => (Some(&item.ident), &item.attrs),
            syn::Item::Union(item) => (Some(&item.ident), &item.attrs),
            syn::Item::Mod(item) => (None, &item.attrs),
            syn::Item::Fn(item) => (None, &item.attrs),
            _ => return visit::visit_item(self, item),
        };
        if is_test_item(attributes) {
            return;
        }
        self.names.extend(name.map(|name| (name.to_string(), name.span())));
        visit::visit_item(self, item);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(files: &[(&str, &str)]) -> Vec<String> {
        check(&Repository::from_texts(files)).iter().map(Violation::to_string).collect()
    }

    #[test]
    fn a_name_of_two_types_is_reported_where_it_comes_again() {
        let files = [
            ("crates/a/src/one.rs", "pub struct Side;"),
            ("crates/b/src/two.rs", "\npub(super) enum Side {}"),
        ];
        assert_eq!(
            found(&files),
            ["crates/b/src/two.rs:2: `Side` is a type of crates/a/src/one.rs too: one name, one thing"]
        );
    }

    #[test]
    fn traits_aliases_and_types_of_functions_count() {
        let aliased = ("crates/a/src/one.rs", "trait Side {}\ntype Rows = u8;");
        assert_eq!(
            found(&[aliased, ("apps/b/src/two.rs", "fn f() { struct Side; }\nstruct Rows;")]).len(),
            2
        );
    }

    #[test]
    fn tests_variants_and_associated_types_do_not_count() {
        let one = ("crates/a/src/one.rs", "struct Side;");
        for other in
            ["#[cfg(test)] mod tests { struct Side; }", "enum Which { Side }", "trait Has { type Side; }"]
        {
            assert_eq!(found(&[one, ("crates/b/src/two.rs", other)]), [""; 0], "{other}");
        }
        assert!(found(&[one, ("crates/b/tests/two.rs", "struct Side;")]).is_empty());
    }
}
