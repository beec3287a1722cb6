//! The guide describes every key of the project file, and no key that there is not.
//!
//! A key is declared in `crates/project/src/` by `key("name", ...)`, `plain("name", ...)`,
//! `part("name", ...)` or `visit("name", ...)`; the words of a choice are pairs `("word", Value)`.

use std::collections::BTreeSet;

use proc_macro2::{TokenStream, TokenTree};

use super::Violation;
use super::links::{code_spans, prose_lines};
use super::notation::tables;
use crate::repository::Repository;

const GUIDE: &str = "book/src/guide/project_file.md";
const DECLARATIONS: &str = "crates/project/src/";
/// There are tables declared, which the guide has as headings, what a catalogue file alone has, and
/// words of JSON Schema.
const NO_KEYS: [&str; 3] =
    ["crates/project/src/lib.rs", "crates/project/src/catalogue/", "crates/project/src/schema"];

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let mut declared = Declared::default();
    let declares =
        |path: &str| path.starts_with(DECLARATIONS) && !NO_KEYS.iter().any(|other| path.starts_with(other));
    for file in repository.rust_files().iter().filter(|file| declares(&file.path)) {
        if let Ok(tokens) = file.text.parse::<TokenStream>() {
            declared.collect(tokens, &file.path, false);
        }
    }
    let guide = repository.text(GUIDE).unwrap_or_default();
    let described: BTreeSet<&str> = prose_lines(guide).flat_map(|(_, line)| code_spans(line)).collect();
    let mut found = Vec::new();
    for (name, path, line) in &declared.names {
        if !name.split('.').all(|part| described.contains(part)) {
            found.push(Violation::new(path, *line, format!("{GUIDE} does not describe `{name}`")));
        }
    }
    let known: BTreeSet<&str> = declared.names.iter().map(|(name, ..)| name.as_str()).collect();
    for row in tables(guide, "means") {
        let lost = row.spans("key").into_iter().filter(|name| !known.contains(name));
        found.extend(lost.map(|name| Violation::new(GUIDE, row.line, format!("there is no key `{name}`"))));
    }
    found
}

#[derive(Default)]
struct Declared {
    names: Vec<(String, String, usize)>,
}

impl Declared {
    /// `arguments` returns whether these tokens are what `key` or its like was called with.
    fn collect(&mut self, tokens: TokenStream, path: &str, arguments: bool) {
        let mut tokens = tokens.into_iter().peekable();
        if let Some(TokenTree::Literal(literal)) = tokens.peek() {
            let text = literal.to_string();
            if let Some(name) =
                text.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')).filter(|_| arguments)
            {
                self.names.push((name.to_string(), path.to_string(), literal.span().start().line));
            }
        }
        let mut word = String::new();
        for token in tokens {
            match token {
                TokenTree::Ident(ident) => word = ident.to_string(),
                TokenTree::Group(group) => {
                    let called = matches!(word.as_str(), "key" | "plain" | "part" | "visit");
                    let pair = word.is_empty() && is_choice(group.stream());
                    self.collect(group.stream(), path, called || pair);
                    word.clear();
                }
                TokenTree::Punct(_) | TokenTree::Literal(_) => word.clear(),
            }
        }
    }
}

/// `"word", Kind::Value` and nothing else.
fn is_choice(tokens: TokenStream) -> bool {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let is_path = |token: &TokenTree| match token {
        TokenTree::Ident(_) => true,
        TokenTree::Punct(sign) => sign.as_char() == ':',
        TokenTree::Group(_) | TokenTree::Literal(_) => false,
    };
    matches!(tokens.as_slice(), [TokenTree::Literal(_), TokenTree::Punct(_), path @ ..]
        if path.len() > 1 && path.iter().all(is_path))
}

#[cfg(test)]
mod tests {
    use super::*;

    const CODE: &str = r#"
        fn visit(v: &mut V) {
            let k = key("bulk_modulus", &PRESSURE, "Of the fluid.").positive();
            v.choice(plain("model", "Which."), &[("lugre", Model::LuGre)], &mut self.model);
            format!("{}", ("not a key", 3));
        }
    "#;

    fn messages(guide: &str) -> Vec<String> {
        let files = [(GUIDE, guide), ("crates/project/src/fluid.rs", CODE)];
        check(&Repository::from_texts(&files)).iter().map(Violation::to_string).collect()
    }

    #[test]
    fn keys_and_words_are_described() {
        let head = "| key | kind | means |\n|---|---|---|\n";
        let rows = "| `bulk_modulus` | pressure | beta_0 |\n| `model` | word | `lugre` |\n";
        assert!(messages(&format!("{head}{rows}")).is_empty());
        assert_eq!(
            messages(&format!("{head}| `model` | word | `lugre` |\n")),
            [
                "crates/project/src/fluid.rs:3: book/src/guide/project_file.md does not describe `bulk_modulus`"
            ]
        );
        assert_eq!(messages(&format!("{head}{rows}| `modulus` | pressure | |\n")).len(), 1);
    }
}
