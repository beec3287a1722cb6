//! TOML text as a tree in which every part has its position.

use toml::Spanned;
use toml::de::{DeTable, DeValue};
use toml_parser::Source;
use toml_parser::lexer::TokenKind;

use super::text::{Findings, Place, RawFinding};

/// Value and its place.
#[derive(Clone, Debug)]
pub struct TreeNode {
    /// Place of the text.
    pub place: Place,
    /// Value at the place.
    pub value: Value,
}

/// Value of the tree.
#[derive(Clone, Debug)]
pub enum Value {
    /// A text.
    Text(String),
    /// A number.
    Number(f64),
    /// True or false.
    Flag(bool),
    /// A date, which no key accepts.
    Date,
    /// A list.
    List(Vec<TreeNode>),
    /// A table, its keys in the order of the file.
    Table(Vec<Entry>),
}

/// Key of a table with its value.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Key.
    pub key: String,
    /// Place of the key.
    pub key_place: Place,
    /// Value.
    pub node: TreeNode,
}

impl TreeNode {
    /// Keys of a table; empty for any other value.
    pub fn entries(&self) -> &[Entry] {
        if let Value::Table(entries) = &self.value { entries } else { &[] }
    }

    /// Key of a table with its value.
    pub fn get(&self, key: &str) -> Option<&Entry> {
        self.entries().iter().find(|entry| entry.key == key)
    }

    /// Kind of value, with an article.
    pub fn kind(&self) -> &'static str {
        match &self.value {
            Value::Text(_) => "a text",
            Value::Number(_) => "a number",
            Value::Flag(_) => "true or false",
            Value::Date => "a date",
            Value::List(_) => "a list",
            Value::Table(_) => "a table",
        }
    }
}

/// Largest file, in bytes.
pub(crate) const MAXIMUM_BYTES: usize = 1 << 20;
/// Deepest nesting of brackets, and most parts of a dotted name.
const MAXIMUM_DEPTH: usize = 16;
/// Largest number of syntax errors that are examined.
const MAXIMUM_SYNTAX_ERRORS: usize = 200;

/// Reads a file: its encoding, size and nesting are checked, then its syntax. `None` if nothing can
/// be read.
pub fn read(name: &str, bytes: &[u8], findings: &mut Findings) -> Option<TreeNode> {
    if bytes.len() > MAXIMUM_BYTES {
        let text = findings.add_text(name, "", 0);
        let message = format!("the file has {} bytes; at most {MAXIMUM_BYTES} are read", bytes.len());
        findings.push(RawFinding::error(Place { text, start: 0, end: 0 }, message).syntax());
        return None;
    }
    let skipped = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
    let content = &bytes[skipped..];
    match std::str::from_utf8(content) {
        Ok(content) => {
            let text = findings.add_text(name, content, skipped);
            document(text, findings)
        }
        Err(error) => {
            let valid = error.valid_up_to();
            let shown = String::from_utf8_lossy(content);
            let text = findings.add_text(name, shown, skipped);
            let place = Place { text, start: valid, end: valid + '\u{fffd}'.len_utf8() };
            let message = format!("byte {} of the file is not valid UTF-8", valid + skipped + 1);
            findings.push(RawFinding::error(place, message).syntax().help("save the file as UTF-8"));
            None
        }
    }
}

/// Reads a text of TOML.
pub(crate) fn document(text: usize, findings: &mut Findings) -> Option<TreeNode> {
    let content = findings.content(text).to_string();
    if let Some(found) = too_deep(text, &content) {
        findings.push(found);
        return None;
    }
    let (table, errors) = DeTable::parse_recoverable(&content);
    for error in errors.iter().take(MAXIMUM_SYNTAX_ERRORS) {
        findings.push(syntax_error(text, &content, error));
    }
    let mut converter = TreeBuilder { text, findings };
    Some(converter.table(table.get_ref(), Place { text, start: 0, end: 0 }))
}

/// Reads a single value of TOML.
pub(crate) fn value(text: usize, range: std::ops::Range<usize>, findings: &mut Findings) -> Option<TreeNode> {
    let content = findings.content(text).get(range.clone())?.to_string();
    if too_deep(text, &content).is_some() {
        return None;
    }
    let value = DeValue::parse(&content).ok()?;
    let mut node = TreeBuilder { text, findings }.node(&value);
    shift(&mut node, range.start);
    Some(node)
}

/// Single value of TOML, with its syntax error among the findings.
pub fn value_or_finding(
    text: usize,
    range: std::ops::Range<usize>,
    findings: &mut Findings,
) -> Option<TreeNode> {
    let content = findings.content(text).get(range.clone())?.to_string();
    let found = value(text, range.clone(), findings);
    if found.is_none() {
        let error = DeValue::parse(&content).err();
        let span = error.as_ref().and_then(toml::de::Error::span).unwrap_or(0..content.len());
        let message = error.map_or("nested too deep".to_string(), |error| error.message().to_string());
        let place = Place { text, start: range.start + span.start, end: range.start + span.end };
        findings.push(RawFinding::error(place, message).syntax());
    }
    found
}

/// Moves a whole tree to its position in the text.
fn shift(node: &mut TreeNode, by: usize) {
    node.place.start += by;
    node.place.end += by;
    match &mut node.value {
        Value::List(items) => items.iter_mut().for_each(|item| shift(item, by)),
        Value::Table(entries) => entries.iter_mut().for_each(|entry| {
            entry.key_place.start += by;
            entry.key_place.end += by;
            shift(&mut entry.node, by);
        }),
        _ => {}
    }
}

/// Finding for too deep nesting. It is checked on the tokens, so that no later walk over the tree
/// can be deep.
fn too_deep(text: usize, content: &str) -> Option<RawFinding> {
    let (mut depth, mut parts) = (0_usize, 0_usize);
    for token in Source::new(content).lex() {
        match token.kind() {
            TokenKind::LeftSquareBracket | TokenKind::LeftCurlyBracket => depth += 1,
            TokenKind::RightSquareBracket | TokenKind::RightCurlyBracket => depth = depth.saturating_sub(1),
            TokenKind::Dot => parts += 1,
            TokenKind::Equals | TokenKind::Comma | TokenKind::Newline => parts = 0,
            _ => {}
        }
        if depth > MAXIMUM_DEPTH || parts > MAXIMUM_DEPTH {
            let place = Place { text, start: token.span().start(), end: token.span().end() };
            let message = format!("nested deeper than {MAXIMUM_DEPTH}");
            return Some(RawFinding::error(place, message).syntax());
        }
    }
    None
}

fn syntax_error(text: usize, content: &str, error: &toml::de::Error) -> RawFinding {
    let span = error.span().unwrap_or(0..0);
    let place = Place { text, start: span.start, end: span.end };
    let message = match content.get(span.clone()) {
        Some(key) if error.message() == "duplicate key" => format!("duplicate key `{key}`"),
        _ => error.message().to_string(),
    };
    let found = RawFinding::error(place, message).syntax();
    let line_start = content[..boundary(content, span.start)].rfind('\n').map_or(0, |at| at + 1);
    let line = content[line_start..].lines().next().unwrap_or_default();
    let help = line.split_once('=').and_then(|(_, value)| quote_help(value.trim()));
    found.maybe_help(help.or_else(|| number_help(line, span.start.saturating_sub(line_start))))
}

/// Nearest position at or before `at` at which a character begins.
fn boundary(content: &str, at: usize) -> usize {
    (0..=at.min(content.len())).rev().find(|at| content.is_char_boundary(*at)).unwrap_or(0)
}

/// Help for a quantity such as `70 bar` without its quotes.
fn quote_help(value: &str) -> Option<String> {
    let value = value.split('#').next().unwrap_or_default().trim();
    let begins_with_digit = value.starts_with(|c: char| c.is_ascii_digit());
    let has_letter = value.contains(|c: char| c.is_alphabetic());
    let plain = !value.contains(['"', '\'', '[', '{', ',']);
    (begins_with_digit && has_letter && plain)
        .then(|| format!("a quantity with its unit is written in quotes: \"{value}\""))
}

/// Help for a number at a place of a line with a decimal comma, or without a digit on one side of
/// its point: `0,8`, `.8` and `8.`, which TOML does not have.
fn number_help(line: &str, at: usize) -> Option<String> {
    let is_of_number = |c: char| c.is_ascii_digit() || matches!(c, '.' | ',' | '-' | '+' | 'e' | 'E');
    let (before, after) = line.split_at_checked(boundary(line, at))?;
    let start = before.rfind(|c| !is_of_number(c)).map_or(0, |last| last + 1);
    let end = at + after.find(|c| !is_of_number(c)).unwrap_or(after.len());
    let written = line.get(start..end)?.trim_end_matches(',');
    let pointed = written.replacen(',', ".", 1);
    let unsigned = pointed.trim_start_matches(['-', '+']);
    let sign = pointed.strip_suffix(unsigned)?;
    let [leading, trailing] = [unsigned.starts_with('.'), unsigned.ends_with('.')];
    let number =
        format!("{sign}{}{unsigned}{}", if leading { "0" } else { "" }, if trailing { "0" } else { "" });
    (number != written && number.parse::<f64>().is_ok())
        .then(|| format!("a number has a decimal point with a digit on both sides: {number}"))
}

/// Builds the tree, and rejects numbers that f64 cannot hold.
struct TreeBuilder<'a> {
    text: usize,
    findings: &'a mut Findings,
}

impl TreeBuilder<'_> {
    fn place(&self, span: std::ops::Range<usize>) -> Place {
        Place { text: self.text, start: span.start, end: span.end }
    }

    /// Entries in the order in which they are written.
    fn table(&mut self, table: &DeTable<'_>, place: Place) -> TreeNode {
        let mut entries: Vec<Entry> = Vec::with_capacity(table.len());
        for (key, value) in table {
            let key_place = self.place(key.span());
            let node = self.node(value);
            entries.push(Entry { key: key.get_ref().to_string(), key_place, node });
        }
        entries.sort_by_key(|entry| (entry.key_place, entry.node.place));
        TreeNode { place, value: Value::Table(entries) }
    }

    fn node(&mut self, value: &Spanned<DeValue<'_>>) -> TreeNode {
        let place = self.place(value.span());
        let value = match value.get_ref() {
            DeValue::String(text) => Value::Text(text.to_string()),
            DeValue::Integer(digits) if digits.radix() == 10 => self.number(digits.as_str(), place),
            DeValue::Integer(digits) => {
                let number = u64::from_str_radix(digits.as_str(), digits.radix()).map(|number| number as f64);
                self.check(number.unwrap_or(f64::INFINITY), place, false)
            }
            DeValue::Float(text) => self.number(text.as_str(), place),
            DeValue::Boolean(value) => Value::Flag(*value),
            DeValue::Datetime(_) => Value::Date,
            DeValue::Array(items) => Value::List(items.iter().map(|item| self.node(item)).collect()),
            DeValue::Table(table) => return self.table(table, place),
        };
        TreeNode { place, value }
    }

    fn number(&mut self, text: &str, place: Place) -> Value {
        let infinite = text.contains("inf");
        let value: f64 = text.parse().unwrap_or(f64::NAN);
        let mantissa = text.split(['e', 'E']).next().unwrap_or_default();
        if value == 0.0 && mantissa.contains(|c: char| c.is_ascii_digit() && c != '0') {
            let message = "the number is too small to be distinguished from zero";
            self.findings.push(RawFinding::error(place, message));
        }
        self.check(value, place, infinite)
    }

    fn check(&mut self, value: f64, place: Place, may_be_infinite: bool) -> Value {
        if value.is_infinite() && !may_be_infinite {
            self.findings.push(RawFinding::error(place, "the number is too large"));
        }
        Value::Number(value)
    }
}

#[cfg(test)]
mod tests {
    use super::number_help;

    #[test]
    fn numbers_that_toml_does_not_have_are_shown_as_it_has_them() {
        for (line, at, number) in [
            ("damping_ratio = 0,8", 17, Some("0.8")),
            ("damping_ratio = .8", 16, Some("0.8")),
            ("gain = -.5", 8, Some("-0.5")),
            ("gain = 8.", 9, Some("8.0")),
            ("k = { nominal = 0,8, minimum = 0.1 }", 18, Some("0.8")),
            ("übersetzung = 1,5", 16, Some("1.5")),
            ("points = 3", 9, None),
            ("frequencies = [1, 2", 19, None),
            ("gain = 1.5.2", 10, None),
        ] {
            let help = number_help(line, at);
            assert_eq!(help.as_deref().and_then(|help| help.rsplit(' ').next()), number, "{line}");
        }
    }
}
