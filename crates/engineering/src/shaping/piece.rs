//! A part of the text of a change, with its position.

use std::ops::Range;

use super::change::RequestedChange;
use super::refused::{ChangeProblem, RefusedChange};

/// A part of a text, without surrounding spaces.
#[derive(Clone, Copy, Debug)]
pub(super) struct TextPiece<'a> {
    pub(super) words: &'a str,
    requested: &'a RequestedChange,
    start: usize,
}

impl<'a> TextPiece<'a> {
    /// The whole text of a change.
    pub(super) fn whole(requested: &'a RequestedChange) -> TextPiece<'a> {
        TextPiece { words: &requested.text, requested, start: 0 }.trimmed()
    }

    pub(super) fn range(&self) -> Range<usize> {
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

    /// The part before an ending.
    pub(super) fn before(&self, ending: &str) -> Option<TextPiece<'a>> {
        let words = self.words.strip_suffix(ending)?;
        Some(TextPiece { words, ..*self }.trimmed())
    }

    /// The first word, and the rest.
    pub(super) fn first_word(&self) -> [TextPiece<'a>; 2] {
        let end = self.words.find(char::is_whitespace).unwrap_or(self.words.len());
        self.cut(end, end)
    }

    /// Rejects the change because of this part.
    pub(super) fn refused(&self, reason: ChangeProblem) -> Box<RefusedChange> {
        self.refused_at(&(0..self.words.len()), reason)
    }

    /// Rejects the change because of a range of this part.
    pub(super) fn refused_at(&self, range: &Range<usize>, reason: ChangeProblem) -> Box<RefusedChange> {
        let part = self.start + range.start..self.start + range.end;
        Box::new(RefusedChange { requested: self.requested.clone(), part, reason })
    }

    fn cut(&self, end: usize, start: usize) -> [TextPiece<'a>; 2] {
        let part = |from: usize, to: usize| {
            let words = self.words.get(from..to).unwrap_or_default();
            TextPiece { words, start: self.start + from, ..*self }.trimmed()
        };
        [part(0, end), part(start, self.words.len())]
    }

    fn trimmed(self) -> TextPiece<'a> {
        let skipped = self.words.len() - self.words.trim_start().len();
        TextPiece { words: self.words.trim(), start: self.start + skipped, ..self }
    }
}
