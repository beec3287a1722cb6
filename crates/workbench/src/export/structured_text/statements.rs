//! Statements of Structured Text.

use std::fmt::Display;

/// A growing list of statements with their indentation.
#[derive(Default)]
pub(super) struct Statements {
    text: String,
    depth: usize,
}

impl Statements {
    /// The statements as text.
    pub(super) fn into_text(self) -> String {
        self.text
    }

    /// A line.
    pub(super) fn line(&mut self, line: impl Display) {
        self.text.push_str(&format!("{}{line}\n", "    ".repeat(self.depth)));
    }

    /// A comment.
    pub(super) fn comment(&mut self, words: &str) {
        self.line(format_args!("(* {words} *)"));
    }

    /// An assignment.
    pub(super) fn assign(&mut self, target: impl Display, value: impl Display) {
        self.line(format_args!("{target} := {value};"));
    }

    /// Statements that run if a condition holds.
    pub(super) fn when(&mut self, condition: impl Display, body: impl FnOnce(&mut Statements)) {
        self.line(format_args!("IF {condition} THEN"));
        self.within(body);
        self.line("END_IF;");
    }

    /// Statements that run if a condition holds, and others if not.
    pub(super) fn choose(
        &mut self,
        condition: impl Display,
        first: impl FnOnce(&mut Statements),
        second: impl FnOnce(&mut Statements),
    ) {
        self.line(format_args!("IF {condition} THEN"));
        self.within(first);
        self.line("ELSE");
        self.within(second);
        self.line("END_IF;");
    }

    /// Statements one level deeper.
    pub(super) fn within(&mut self, body: impl FnOnce(&mut Statements)) {
        self.depth += 1;
        body(self);
        self.depth -= 1;
    }
}

/// A number with as many digits as distinguish it from every other.
///
/// ```text
/// 17 significant digits, such as 1.0000000000000001E-01
/// ```
pub(super) fn literal(value: f64) -> String {
    let text = format!("{value:.16E}");
    let (mantissa, exponent) = text.split_once('E').unwrap_or((&text, "0"));
    let exponent = match exponent.strip_prefix('-') {
        Some(digits) => format!("-{digits:0>2}"),
        None => format!("+{exponent:0>2}"),
    };
    format!("{mantissa}E{exponent}")
}
