//! Errors of a file: their location, and the expected content.

use std::ops::Range;

use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};

/// Finding in a file or setting.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Severity: an error rejects the file.
    pub severity: Severity,
    /// Fault, in one sentence.
    pub message: String,
    /// File, or `--set` and its text.
    pub file: String,
    /// Line, from 1; 0 for the file as a whole.
    pub line: usize,
    /// Column in characters, from 1; 0 for the file as a whole.
    pub column: usize,
    /// Line and column after the last character of the place; `None` for the file as a whole.
    pub end: Option<[usize; 2]>,
    /// Range in bytes of the file.
    pub span: Range<usize>,
    /// Expected content.
    pub expected: Option<String>,
    /// Nearest valid name, or a remedy.
    pub help: Option<String>,
}

/// Effect of a finding on the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The file is rejected.
    Error,
    /// The file is accepted.
    Warning,
}

/// Error for a rejected project: every finding of one run, and the texts to which they refer.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Refusal {
    /// Errors first, each in file order.
    pub diagnostics: Vec<Diagnostic>,
    /// Number of further errors that are not listed.
    pub more: usize,
    /// Name and content of every text to which a diagnostic refers.
    pub texts: Vec<(String, String)>,
}

/// Longest line that is shown, in bytes.
const MAXIMUM_SHOWN: usize = 400;

/// Findings for people: each with its line, the expected content and a remedy. `styled` adds
/// terminal colours.
pub fn render(diagnostics: &[Diagnostic], texts: &[(String, String)], styled: bool) -> String {
    let renderer = if styled { Renderer::styled() } else { Renderer::plain() };
    let one = |diagnostic: &Diagnostic| renderer.render(&diagnostic.groups(texts));
    diagnostics.iter().map(one).collect::<Vec<_>>().join("\n\n")
}

impl Refusal {
    /// All findings for people; see [`render`].
    pub fn render(&self, styled: bool) -> String {
        let listed = render(&self.diagnostics, &self.texts, styled);
        if self.more == 0 { listed } else { format!("{listed}\n\n... and {} more", self.more) }
    }
}

impl std::fmt::Display for Refusal {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for Refusal {}

impl Diagnostic {
    fn groups<'a>(&'a self, texts: &'a [(String, String)]) -> Vec<Group<'a>> {
        let level = match self.severity {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
        };
        let title = level.primary_title(self.message.as_str());
        let content = texts.iter().find(|(name, _)| *name == self.file).map(|(_, content)| content.as_str());
        let line = self.line.checked_sub(1).and_then(|index| content?.lines().nth(index));
        let group = match line.filter(|line| line.len() <= MAXIMUM_SHOWN) {
            Some(line) => title.element(self.snippet(line)),
            None => title.element(self.origin()),
        };
        let help = self.help.iter().map(|help| Group::with_title(Level::HELP.secondary_title(help.as_str())));
        std::iter::once(group).chain(help).collect()
    }

    /// Line with the span underlined and the expectation next to it.
    fn snippet<'a>(&'a self, line: &'a str) -> Snippet<'a, annotate_snippets::Annotation<'a>> {
        let start: usize = line.chars().take(self.column.saturating_sub(1)).map(char::len_utf8).sum();
        let mut end = (start + self.span.len()).min(line.len());
        while !line.is_char_boundary(end) {
            end += 1;
        }
        let label = self.expected.as_ref().map(|expected| format!("expected {expected}"));
        let annotation = AnnotationKind::Primary.span(start..end.max(start)).label(label);
        Snippet::source(line).line_start(self.line).path(self.file.as_str()).annotation(annotation)
    }

    fn origin(&self) -> Origin<'_> {
        let origin = Origin::path(self.file.as_str());
        if self.line == 0 { origin } else { origin.line(self.line).char_column(self.column) }
    }
}

/// Error of a valid project that becomes known only when its rig is computed.
#[derive(Clone, Debug, PartialEq)]
pub struct LateError {
    /// Path of the key.
    pub path: String,
    /// Fault.
    pub message: String,
    /// Remedy; empty if there is none.
    pub help: String,
}

impl LateError {
    /// Error for a file that cannot be read.
    pub fn of_file(path: String, message: String) -> LateError {
        LateError { path, message, help: "paths are relative to the project file".to_string() }
    }

    /// Error and its remedy in one sentence.
    pub fn sentence(&self) -> String {
        format!("{}: {}", self.message, self.help)
    }
}
