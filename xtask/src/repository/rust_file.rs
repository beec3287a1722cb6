use std::collections::BTreeSet;

use proc_macro2::{TokenStream, TokenTree};
use syn::spanned::Spanned;
use syn::visit::{self, Visit};

/// One Rust source file, parsed.
pub(crate) struct RustFile {
    /// Path from the repository's root.
    pub(crate) path: String,
    /// The text as it stands.
    pub(crate) text: String,
    /// The syntax tree.
    pub(crate) syntax: syn::File,
}

impl RustFile {
    pub(crate) fn new(path: &str, text: &str, syntax: syn::File) -> RustFile {
        RustFile { path: path.to_string(), text: text.to_string(), syntax }
    }

    /// Whether the whole file is test code, or an example, by where it lies.
    pub(crate) fn is_test_file(&self) -> bool {
        let folder = |name: &str| self.path.contains(&format!("/{name}/"));
        ["tests", "benches", "fuzz", "examples"].into_iter().any(folder) || self.path.ends_with("/tests.rs")
    }

    /// What the shipped code mentions; test code is left out.
    pub(crate) fn shipped(&self) -> Mentions {
        let mut mentions = Mentions::default();
        if !self.is_test_file() {
            mentions.visit_file(&self.syntax);
        }
        mentions
    }

    /// Every word the code consists of, comments left out.
    pub(crate) fn words(&self) -> BTreeSet<String> {
        let mut words = BTreeSet::new();
        if let Ok(tokens) = self.text.parse::<TokenStream>() {
            collect_words(tokens, &mut words);
        }
        words
    }
}

fn collect_words(tokens: TokenStream, words: &mut BTreeSet<String>) {
    for token in tokens {
        match token {
            TokenTree::Ident(word) => {
                words.insert(word.to_string());
            }
            TokenTree::Group(group) => collect_words(group.stream(), words),
            TokenTree::Punct(_) | TokenTree::Literal(_) => {}
        }
    }
}

/// Whether an item is compiled for tests only: `#[test]`, `#[cfg(test)]`.
pub(crate) fn is_test_item(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|attribute| match &attribute.meta {
        syn::Meta::Path(path) => path.is_ident("test"),
        syn::Meta::List(list) if list.path.is_ident("cfg") => {
            let mut words = BTreeSet::new();
            collect_words(list.tokens.clone(), &mut words);
            words.contains("test") && !words.contains("not")
        }
        _ => false,
    })
}

/// What code mentions, each with its line.
#[derive(Default)]
pub(crate) struct Mentions {
    /// Paths such as `std::fs::read`, `use` trees written out.
    pub(crate) paths: Vec<(String, usize)>,
    /// Literal numbers.
    pub(crate) numbers: Vec<(f64, usize)>,
}

impl Mentions {
    fn use_tree(&mut self, prefix: &str, tree: &syn::UseTree) {
        let joined = |name: String| if prefix.is_empty() { name } else { format!("{prefix}::{name}") };
        let line = tree.span().start().line;
        match tree {
            syn::UseTree::Path(path) => self.use_tree(&joined(path.ident.to_string()), &path.tree),
            syn::UseTree::Name(name) => self.paths.push((joined(name.ident.to_string()), line)),
            syn::UseTree::Rename(rename) => self.paths.push((joined(rename.ident.to_string()), line)),
            syn::UseTree::Glob(_) => self.paths.push((joined("*".to_string()), line)),
            syn::UseTree::Group(group) => group.items.iter().for_each(|item| self.use_tree(prefix, item)),
        }
    }

    fn tokens(&mut self, tokens: TokenStream) {
        let mut path = String::new();
        let mut line = 0;
        for token in tokens {
            match token {
                TokenTree::Ident(word) => {
                    if !path.ends_with("::") {
                        self.finish(&mut path, line);
                        line = word.span().start().line;
                    }
                    path.push_str(&word.to_string());
                }
                TokenTree::Punct(sign) if sign.as_char() == ':' => path.push(':'),
                TokenTree::Group(group) => {
                    self.finish(&mut path, line);
                    self.tokens(group.stream());
                }
                TokenTree::Literal(literal) => {
                    self.finish(&mut path, line);
                    self.visit_lit(&syn::Lit::new(literal));
                }
                TokenTree::Punct(_) => self.finish(&mut path, line),
            }
        }
        self.finish(&mut path, line);
    }

    fn finish(&mut self, path: &mut String, line: usize) {
        if !path.is_empty() {
            self.paths.push((std::mem::take(path), line));
        }
    }
}

impl<'ast> Visit<'ast> for Mentions {
    fn visit_item(&mut self, item: &'ast syn::Item) {
        let attributes: &[syn::Attribute] = match item {
            syn::Item::Fn(function) => &function.attrs,
            syn::Item::Mod(module) => &module.attrs,
            syn::Item::Impl(block) => &block.attrs,
            syn::Item::Use(import) => &import.attrs,
            _ => &[],
        };
        if !is_test_item(attributes) {
            visit::visit_item(self, item);
        }
    }

    fn visit_impl_item_fn(&mut self, function: &'ast syn::ImplItemFn) {
        if !is_test_item(&function.attrs) {
            visit::visit_impl_item_fn(self, function);
        }
    }

    fn visit_item_use(&mut self, import: &'ast syn::ItemUse) {
        self.use_tree("", &import.tree);
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let names: Vec<String> = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        self.paths.push((names.join("::"), path.span().start().line));
        visit::visit_path(self, path);
    }

    fn visit_lit(&mut self, literal: &'ast syn::Lit) {
        let digits = match literal {
            syn::Lit::Float(number) => number.base10_digits(),
            syn::Lit::Int(number) => number.base10_digits(),
            _ => return,
        };
        if let Ok(number) = digits.parse() {
            self.numbers.push((number, literal.span().start().line));
        }
    }

    fn visit_meta_list(&mut self, list: &'ast syn::MetaList) {
        self.visit_path(&list.path);
        self.tokens(list.tokens.clone());
    }

    fn visit_macro(&mut self, invocation: &'ast syn::Macro) {
        self.visit_path(&invocation.path);
        self.tokens(invocation.tokens.clone());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paths(text: &str) -> Vec<String> {
        let file = RustFile::new("crates/a/src/lib.rs", text, syn::parse_file(text).unwrap());
        file.shipped().paths.into_iter().map(|(path, _)| path).collect()
    }

    #[test]
    fn use_trees_are_written_out() {
        assert_eq!(
            paths("use std::{fs, time::{Instant as Now, *}};"),
            ["std::fs", "std::time::Instant", "std::time::*"]
        );
    }

    #[test]
    fn derives_and_macros_are_looked_into() {
        assert!(
            paths("#[derive(Clone, serde::Serialize)] struct A;").contains(&"serde::Serialize".to_string())
        );
        assert!(paths("fn f() { vec![std::fs::read(x)]; }").contains(&"std::fs::read".to_string()));
    }

    #[test]
    fn test_code_is_left_out() {
        assert!(paths("#[cfg(test)] mod tests { use std::fs; }").is_empty());
        assert!(paths("#[test] fn f() { std::fs::read(x); }").is_empty());
        assert_eq!(paths("#[cfg(not(test))] mod m { use std::fs; }").last().unwrap(), "std::fs");
    }

    #[test]
    fn lines_are_those_of_the_text() {
        let text = "//! head\n\nfn f() {\n    std::fs::read(x);\n}\n";
        let file = RustFile::new("crates/a/src/lib.rs", text, syn::parse_file(text).unwrap());
        assert!(file.shipped().paths.contains(&("std::fs::read".to_string(), 4)));
    }

    #[test]
    fn numbers_are_read_in_code_and_in_macros() {
        let text = "const A: f64 = 6_894.757e0; fn f() { vec![-25.4, 3]; }";
        let file = RustFile::new("a.rs", text, syn::parse_file(text).unwrap());
        assert_eq!(file.shipped().numbers, [(6894.757, 1), (25.4, 1), (3.0, 1)]);
    }

    #[test]
    fn words_come_from_code_and_not_from_comments() {
        let text = "/// not_here\nfn here() { vec![inside] }";
        let file = RustFile::new("a.rs", text, syn::parse_file(text).unwrap());
        let words = file.words();
        assert!(words.contains("here") && words.contains("inside") && !words.contains("not_here"));
    }
}
