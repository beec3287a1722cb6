//! TOML text divided into its statements: headers, keys with their values, and lines without
//! either.

use std::ops::Range;

use toml_parser::Source;
use toml_parser::lexer::{Token, TokenKind};

/// Whole lines of a text.
pub(super) struct Statement {
    pub(super) content: StatementContent,
    /// Range in bytes of the text, including its line end.
    pub(super) range: Range<usize>,
}

/// Content of a statement.
pub(super) enum StatementContent {
    /// Space or a comment.
    Nothing,
    /// Header `[a.b]` or `[[a.b]]`.
    Header(Vec<String>),
    /// Assignment `a.b = value`.
    Value {
        /// Parts of the key.
        path: Vec<String>,
        /// Range of the value in bytes of the statement.
        value: Range<usize>,
    },
}

/// Statements of a valid TOML text, in order and without gaps.
pub(super) fn statements(text: &str) -> Vec<Statement> {
    let mut found = Vec::new();
    let (mut line, mut start, mut depth) = (Vec::new(), 0, 0_usize);
    for token in Source::new(text).lex() {
        let key_is_over = line.iter().any(|token: &Token| token.kind() == TokenKind::Equals);
        match token.kind() {
            TokenKind::LeftSquareBracket | TokenKind::LeftCurlyBracket if key_is_over => depth += 1,
            TokenKind::RightSquareBracket | TokenKind::RightCurlyBracket => depth = depth.saturating_sub(1),
            _ => {}
        }
        let ends = token.kind() == TokenKind::Eof || token.kind() == TokenKind::Newline && depth == 0;
        if !ends {
            line.push(token);
            continue;
        }
        let end = token.span().end();
        if end > start {
            found.push(Statement { content: content(text, start, &line), range: start..end });
        }
        line.clear();
        start = end;
    }
    found
}

/// Entries of an inline table, each with the first part of its key and its text.
pub(super) fn entries(table: &str) -> Vec<(String, String)> {
    let mut found: Vec<(String, String)> = Vec::new();
    let (mut depth, mut parts) = (0_usize, vec![Vec::new()]);
    for token in Source::new(table).lex() {
        let outside = matches!(token.kind(), TokenKind::Comma) && depth == 1;
        match token.kind() {
            TokenKind::LeftSquareBracket | TokenKind::LeftCurlyBracket => depth += 1,
            TokenKind::RightSquareBracket | TokenKind::RightCurlyBracket => depth = depth.saturating_sub(1),
            _ => {}
        }
        let brace = match token.kind() {
            TokenKind::LeftCurlyBracket => depth == 1,
            TokenKind::RightCurlyBracket => depth == 0,
            _ => false,
        };
        if outside {
            parts.push(Vec::new());
        } else if let Some(part) = parts.last_mut().filter(|_| !brace && token.kind() != TokenKind::Eof) {
            part.push(token);
        }
    }
    for part in parts {
        let (Some(first), Some(last)) = (part.first(), part.last()) else { continue };
        let Some(key) = path(table, &part).into_iter().next() else { continue };
        let text = table.get(first.span().start()..last.span().end()).unwrap_or_default();
        found.push((key, text.trim().to_string()));
    }
    found
}

fn content(text: &str, start: usize, line: &[Token]) -> StatementContent {
    let empty = |kind| matches!(kind, TokenKind::Whitespace | TokenKind::Comment);
    let mut written = line.iter().filter(|token| !empty(token.kind()));
    let Some(first) = written.next() else { return StatementContent::Nothing };
    if first.kind() == TokenKind::LeftSquareBracket {
        return StatementContent::Header(path(text, line));
    }
    let mut behind = line.iter().skip_while(|token| token.kind() != TokenKind::Equals).skip(1);
    let behind: Vec<&Token> = behind.by_ref().filter(|token| !empty(token.kind())).collect();
    let value = match (behind.first(), behind.last()) {
        (Some(first), Some(last)) => first.span().start() - start..last.span().end() - start,
        _ => 0..0,
    };
    StatementContent::Value { path: path(text, line), value }
}

/// Names before `=` or between the brackets of a header.
fn path(text: &str, line: &[Token]) -> Vec<String> {
    let names = line
        .iter()
        .take_while(|token| !matches!(token.kind(), TokenKind::Equals | TokenKind::RightSquareBracket));
    let is_name = |token: &&Token| {
        matches!(token.kind(), TokenKind::Atom | TokenKind::BasicString | TokenKind::LiteralString)
    };
    let name = |token: &Token| text.get(token.span().start()..token.span().end()).unwrap_or_default();
    names.filter(is_name).map(|token| name(token).trim_matches(['"', '\'']).to_string()).collect()
}
