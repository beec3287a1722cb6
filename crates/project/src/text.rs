//! Texts, positions in them, and findings: the common basis of all file reading.

use super::diagnostic::{Diagnostic, Refusal, Severity};

/// Place in a text: the text, and its bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// Index of the text.
    pub text: usize,
    /// First byte.
    pub start: usize,
    /// First byte after it.
    pub end: usize,
}

/// Texts that are read, and the findings in them.
#[derive(Clone, Debug, Default)]
pub struct Findings {
    texts: Vec<NamedText>,
    found: Vec<RawFinding>,
    /// Numbers of kept errors and warnings, and of findings that are not kept.
    errors: usize,
    warnings: usize,
    more: usize,
}

/// Named text.
#[derive(Clone, Debug)]
struct NamedText {
    name: String,
    content: String,
    /// Bytes of the file before the content, such as a byte order mark.
    skipped: usize,
}

/// Finding before its line and column are determined.
#[derive(Clone, Debug)]
pub struct RawFinding {
    severity: Severity,
    place: Place,
    message: String,
    expected: Option<String>,
    help: Option<String>,
    /// True if it can be the consequence of a syntax error elsewhere.
    consequence: bool,
    syntax: bool,
}

impl RawFinding {
    /// Error at a place.
    pub fn error(place: Place, message: impl Into<String>) -> Self {
        let message = message.into();
        let severity = Severity::Error;
        RawFinding { severity, place, message, expected: None, help: None, consequence: false, syntax: false }
    }

    /// Warning at a place.
    pub fn warning(place: Place, message: impl Into<String>) -> Self {
        RawFinding { severity: Severity::Warning, ..RawFinding::error(place, message) }
    }

    /// Finding at another place.
    pub(crate) fn at(self, place: Place) -> Self {
        RawFinding { place, ..self }
    }

    /// Finding with the expectation.
    pub fn expected(mut self, expected: impl Into<String>) -> Self {
        self.expected = Some(expected.into());
        self
    }

    /// Finding with the expectation, if known.
    pub fn maybe_expected(mut self, expected: Option<String>) -> Self {
        self.expected = expected.or(self.expected);
        self
    }

    /// Finding with a remedy.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Finding with a remedy, if known.
    pub fn maybe_help(mut self, help: Option<String>) -> Self {
        self.help = help.or(self.help);
        self
    }

    /// Finding for this number of rows of a table, of which this is the first.
    pub fn and_more(mut self, rows: usize) -> Self {
        self.message = format!("{}; {rows} rows are like this", self.message);
        self
    }

    /// Finding for something missing, possibly because of a syntax error.
    pub(crate) fn consequence(mut self) -> Self {
        self.consequence = true;
        self
    }

    /// Finding as an error of syntax, of which others may be a consequence.
    pub(crate) fn syntax(mut self) -> Self {
        self.syntax = true;
        self
    }
}

/// Largest number of listed findings; further ones are only counted.
const MAXIMUM_LISTED: usize = 200;
/// Largest number of kept errors, or warnings; further ones are only counted, so that the work for
/// each stays small.
const MAXIMUM_KEPT: usize = 400;

impl Findings {
    /// Adds a text and returns its index.
    pub fn add_text(&mut self, name: &str, content: impl Into<String>, skipped: usize) -> usize {
        self.texts.push(NamedText { name: name.to_string(), content: content.into(), skipped });
        self.texts.len() - 1
    }

    /// Releases the memory of a text without findings, present or future.
    pub fn release(&mut self, text: usize) {
        if self.found.iter().all(|found| found.place.text != text)
            && let Some(text) = self.texts.get_mut(text)
        {
            text.content = String::new();
        }
    }

    /// Index of the text added last.
    pub(crate) fn last_text(&self) -> usize {
        self.texts.len().saturating_sub(1)
    }

    /// Adds a finding; beyond the largest number of kept findings it is only counted.
    pub fn push(&mut self, found: RawFinding) {
        let kept = if found.severity == Severity::Error { &mut self.errors } else { &mut self.warnings };
        if *kept < MAXIMUM_KEPT {
            *kept += 1;
            self.found.push(found);
        } else {
            self.more += 1;
        }
    }

    /// Content of a text; empty for an index without one.
    pub fn content(&self, text: usize) -> &str {
        self.texts.get(text).map_or("", |text| &text.content)
    }

    /// Number of kept errors.
    pub fn error_count(&self) -> usize {
        self.errors
    }

    /// The value that was read, unless an error was found.
    ///
    /// # Errors
    /// All findings.
    pub fn or_refused<T>(self, read: T) -> Result<T, Box<Refusal>> {
        if self.errors > 0 { Err(Box::new(self.report())) } else { Ok(read) }
    }

    /// True if an error was found.
    pub fn has_errors(&self) -> bool {
        self.found.iter().any(|found| found.severity == Severity::Error)
    }

    /// True if a value within a place was already rejected.
    pub(crate) fn has_error_within(&self, place: Place) -> bool {
        let within = |inner: &Place| {
            inner.text == place.text && inner.start >= place.start && inner.end <= place.end && place.end > 0
        };
        self.found.iter().any(|found| found.severity == Severity::Error && within(&found.place))
    }

    /// All findings, in order of position, without those that a syntax error of the same text
    /// explains.
    pub fn report(self) -> Refusal {
        let Findings { texts, mut found, more, .. } = self;
        let is_named = |index: usize| found.iter().any(|f| f.place.text == index);
        let starts =
            |(index, text): (usize, &NamedText)| if is_named(index) { text.line_starts() } else { vec![] };
        let lines: Vec<Vec<usize>> = texts.iter().enumerate().map(starts).collect();
        let line = |place: &Place| lines.get(place.text).map_or(0, |starts| line_of(starts, place.start));
        let broken: Vec<(usize, usize)> =
            found.iter().filter(|f| f.syntax).map(|f| (f.place.text, line(&f.place))).collect();
        found.retain(|f| {
            let explained = broken.contains(&(f.place.text, line(&f.place)));
            f.syntax || !(explained || f.consequence && !broken.is_empty())
        });
        found.sort_by(|a, b| (a.severity, a.place, &a.message).cmp(&(b.severity, b.place, &b.message)));
        found.dedup_by(|a, b| a.place == b.place && a.message == b.message);
        let more = more + found.len().saturating_sub(MAXIMUM_LISTED);
        found.truncate(MAXIMUM_LISTED);
        let diagnostic =
            |f: &RawFinding| Some(texts.get(f.place.text)?.diagnostic(f, lines.get(f.place.text)?));
        let diagnostics = found.iter().filter_map(diagnostic).collect();
        Refusal {
            diagnostics,
            more,
            texts: texts.into_iter().map(|text| (text.name, text.content)).collect(),
        }
    }
}

impl NamedText {
    /// Beginnings of the lines.
    fn line_starts(&self) -> Vec<usize> {
        let ends = self.content.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
        std::iter::once(0).chain(ends.map(|(at, _)| at + 1)).collect()
    }

    /// Line and column of a byte, in characters from 1.
    fn line_and_column(&self, at: usize, line_starts: &[usize]) -> [usize; 2] {
        let line = line_of(line_starts, at);
        let line_start = line.checked_sub(1).and_then(|index| line_starts.get(index)).copied().unwrap_or(0);
        let before = self.content.get(line_start..at).unwrap_or_default();
        [line, before.chars().count() + 1]
    }

    fn diagnostic(&self, found: &RawFinding, line_starts: &[usize]) -> Diagnostic {
        let end = self.content.len();
        let (from, to) = (found.place.start.min(end), found.place.end.min(end));
        let whole_file = self.content.is_empty();
        let [line, column] = self.line_and_column(from, line_starts);
        Diagnostic {
            severity: found.severity,
            message: found.message.clone(),
            file: self.name.clone(),
            line: if whole_file { 0 } else { line },
            column: if whole_file { 0 } else { column },
            end: (!whole_file).then(|| self.line_and_column(to.max(from), line_starts)),
            span: from + self.skipped..to.max(from) + self.skipped,
            expected: found.expected.clone(),
            help: found.help.clone(),
        }
    }
}

/// Line of a byte, from 1.
fn line_of(line_starts: &[usize], at: usize) -> usize {
    line_starts.partition_point(|start| *start <= at)
}
