//! Comments of Rust and prose of Markdown are at most 100 columns wide, as far as they can be
//! broken.

use std::collections::BTreeSet;

use proc_macro2::{TokenStream, TokenTree};

use super::Violation;
use crate::repository::Repository;

const WIDTH: usize = 100;

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let rust = repository.rust_files().iter().flat_map(|file| {
        let comments = comments(&file.text);
        wide(comments).map(|line| Violation::new(&file.path, line, "a comment of more than 100 columns"))
    });
    let markdown = repository.texts(|path| path.ends_with(".md")).flat_map(|(path, text)| {
        let prose =
            text.lines().enumerate().map(|(index, line)| Line { number: index + 1, line, content: line });
        wide(prose).map(|line| Violation::new(path, line, "a line of more than 100 columns"))
    });
    rust.chain(markdown).collect()
}

/// A line of a comment or of prose, counted from 1, and what follows the mark of a comment.
struct Line<'a> {
    number: usize,
    line: &'a str,
    content: &'a str,
}

/// Numbers of the lines that are too wide: not in fences, tables, headings and code, without a
/// link, and with a space at which they can be broken.
fn wide<'a>(lines: impl Iterator<Item = Line<'a>>) -> impl Iterator<Item = usize> {
    let mut fence: Option<String> = None;
    let mut before = 0;
    lines.filter_map(move |Line { number, line, content }| {
        let bare = content.trim();
        if number != before + 1 {
            fence = None;
        }
        before = number;
        let mark: String = bare.chars().take_while(|c| matches!(c, '`' | '~')).collect();
        if mark.len() >= 3 {
            match &fence {
                None => fence = Some(mark),
                Some(open) if bare.starts_with(open.as_str()) => fence = None,
                Some(_) => {}
            }
            return None;
        }
        let is_prose =
            fence.is_none() && !bare.starts_with(['|', '#', '<', '>', '$']) && !is_aligned(content);
        (is_prose && is_wide(line, bare)).then_some(number)
    })
}

/// Code, or columns that are set with spaces.
fn is_aligned(content: &str) -> bool {
    content.trim().contains("   ")
}

fn is_wide(line: &str, bare: &str) -> bool {
    let columns = line.chars().count();
    let start = line.trim_end().chars().count() - without_mark(bare).chars().count();
    let has_link = line.contains("](") || line.contains("://");
    let can_break = line.chars().take(WIDTH + 1).skip(start).any(|c| c == ' ');
    columns > WIDTH && !has_link && can_break
}

/// A line without the mark of a list.
fn without_mark(bare: &str) -> &str {
    let numbered = bare.trim_start_matches(|c: char| c.is_ascii_digit());
    let marks = ["- ", "* ", "+ "].iter().find_map(|mark| bare.strip_prefix(mark));
    let number = numbered.strip_prefix(". ").filter(|_| numbered.len() < bare.len());
    marks.or(number).unwrap_or(bare)
}

/// The lines that are comments alone; a line inside a longer literal is none, whatever it shows.
fn comments(text: &str) -> impl Iterator<Item = Line<'_>> {
    let mut inside = BTreeSet::new();
    if let Ok(tokens) = text.parse() {
        inside_literals(tokens, &mut inside);
    }
    text.lines().enumerate().filter_map(move |(index, line)| {
        let number = index + 1;
        let comment = line.trim_start().strip_prefix("//").filter(|_| !inside.contains(&number))?;
        Some(Line { number, line, content: comment.trim_start_matches(['/', '!']) })
    })
}

fn inside_literals(tokens: TokenStream, lines: &mut BTreeSet<usize>) {
    for token in tokens {
        match token {
            TokenTree::Group(group) => inside_literals(group.stream(), lines),
            TokenTree::Literal(literal) => {
                lines.extend(literal.span().start().line + 1..=literal.span().end().line)
            }
            TokenTree::Ident(_) | TokenTree::Punct(_) => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(path: &str, text: &str) -> Vec<usize> {
        check(&Repository::from_texts(&[(path, text)])).iter().map(|violation| violation.line).collect()
    }

    /// Words of together so many columns.
    fn words(columns: usize) -> String {
        "word ".repeat(columns / 5) + &"w".repeat(columns % 5)
    }

    #[test]
    fn a_comment_may_have_a_hundred_columns() {
        for mark in ["// ", "/// ", "//! "] {
            let comment = |columns: usize| format!("{mark}{}\nfn f() {{}}\n", words(columns - mark.len()));
            assert_eq!(lines("a.rs", &comment(99)), [0; 0], "{mark}");
            assert_eq!(lines("a.rs", &comment(101)), [1], "{mark}");
        }
    }

    #[test]
    fn what_cannot_be_broken_and_what_is_not_prose_pass() {
        let long = words(121);
        for text in [
            format!("```text\n{long}\n```"),
            format!("| {long} |"),
            format!("# {long}"),
            format!("[a link](there) {long}"),
            "w".repeat(121),
            format!("- {}", "w".repeat(121)),
        ] {
            assert_eq!(lines("a.md", &text), [0; 0], "{text}");
            let comment: String = text.lines().map(|line| format!("/// {line}\n")).collect();
            assert_eq!(lines("a.rs", &format!("{comment}fn f() {{}}\n")), [0; 0], "{text}");
        }
        assert_eq!(lines("a.rs", &format!("const A: &str = \"\n// {long}\n\";\n")), [0; 0]);
        assert_eq!(lines("a.rs", &format!("fn f() {{ g() }} // {long}\n")), [0; 0]);
    }

    #[test]
    fn prose_of_markdown_and_items_of_lists_are_measured() {
        let long = words(121);
        assert_eq!(lines("a.md", &format!("short\n\n- {long}\n1. {long}\n")), [3, 4]);
        assert_eq!(lines("a.md", &format!("```\n{long}\n```\n{long}\n")), [4]);
    }
}
