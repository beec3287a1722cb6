//! A part of a text that knows its position.

use crate::project::{Findings, Place, RawFinding};

/// A part of a text, without the space around it.
#[derive(Clone, Copy, Debug)]
pub(super) struct TextPiece<'a> {
    pub(super) words: &'a str,
    text: usize,
    start: usize,
}

impl<'a> TextPiece<'a> {
    /// The whole of a text.
    pub(super) fn whole(words: &'a str, text: usize) -> TextPiece<'a> {
        TextPiece { words, text, start: 0 }.trimmed()
    }

    pub(super) fn place(&self) -> Place {
        Place { text: self.text, start: self.start, end: self.start + self.words.len() }
    }

    /// The position of a part of it.
    pub(super) fn place_of(&self, range: &std::ops::Range<usize>) -> Place {
        Place { text: self.text, start: self.start + range.start, end: self.start + range.end }
    }

    pub(super) fn text(&self) -> usize {
        self.text
    }

    pub(super) fn range(&self) -> std::ops::Range<usize> {
        self.start..self.start + self.words.len()
    }

    /// The parts before and after the first occurrence of a separator.
    pub(super) fn split(&self, separator: &str) -> Option<[TextPiece<'a>; 2]> {
        self.words.find(separator).map(|at| self.cut(at, at + separator.len()))
    }

    /// The parts before and after the last occurrence of a separator.
    pub(super) fn split_last(&self, separator: &str) -> Option<[TextPiece<'a>; 2]> {
        self.words.rfind(separator).map(|at| self.cut(at, at + separator.len()))
    }

    /// What stands before an ending.
    pub(super) fn before(&self, ending: &str) -> Option<TextPiece<'a>> {
        let words = self.words.strip_suffix(ending)?;
        Some(TextPiece { words, ..*self }.trimmed())
    }

    /// Its first word, and the rest.
    pub(super) fn first_word(&self) -> [TextPiece<'a>; 2] {
        let end = self.words.find(char::is_whitespace).unwrap_or(self.words.len());
        self.cut(end, end)
    }

    /// Refuses it.
    pub(super) fn refuse<T>(
        &self,
        findings: &mut Findings,
        message: impl Into<String>,
        help: &str,
    ) -> Option<T> {
        findings.push(RawFinding::error(self.place(), message).help(help));
        None
    }

    fn cut(&self, end: usize, start: usize) -> [TextPiece<'a>; 2] {
        let part = |from: usize, to: usize| {
            let words = self.words.get(from..to).unwrap_or_default();
            TextPiece { words, text: self.text, start: self.start + from }.trimmed()
        };
        [part(0, end), part(start, self.words.len())]
    }

    fn trimmed(self) -> TextPiece<'a> {
        let skipped = self.words.len() - self.words.trim_start().len();
        TextPiece { words: self.words.trim(), start: self.start + skipped, ..self }
    }
}
