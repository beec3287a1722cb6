//! Values of a row, as written.

use crate::project::Place;

/// Separator between two values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Separator {
    /// A sign of one byte.
    Sign(u8),
    /// Spaces, any number of them.
    Spaces,
}

/// A value as written, without the spaces and quotes around it, and its first byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct TextCell<'a> {
    pub(super) text: &'a str,
    pub(super) start: usize,
}

impl TextCell<'_> {
    /// Place in the text with this index.
    pub(super) fn place(&self, text: usize) -> Place {
        Place { text, start: self.start, end: self.start + self.text.len() }
    }
}

/// The values of one row, from left to right.
pub(super) struct Cells<'a> {
    content: &'a str,
    /// Position of the next value; after the last one, of the next row.
    pub(super) at: usize,
    separator: Separator,
    has_ended: bool,
}

/// The longest value in quotes: a quote that is not closed is a sign like any other.
const LONGEST_QUOTED: usize = 1000;

impl<'a> Cells<'a> {
    /// Row that starts at a byte.
    pub(super) fn new(content: &'a str, start: usize, separator: Separator) -> Cells<'a> {
        Cells { content, at: start, separator, has_ended: false }
    }

    /// Reads up to the next row and returns its first byte.
    pub(super) fn end(mut self) -> usize {
        while self.next().is_some() {}
        self.at
    }

    fn is_separator(&self, byte: u8) -> bool {
        match self.separator {
            Separator::Sign(sign) => byte == sign,
            Separator::Spaces => byte == b' ' || byte == b'\t',
        }
    }

    /// Index of the first byte from here that is not a space.
    fn past_spaces(&self, mut at: usize) -> usize {
        let bytes = self.content.as_bytes();
        let is_space = |byte: u8| byte == b' ' || (byte == b'\t' && self.separator != Separator::Sign(b'\t'));
        while bytes.get(at).is_some_and(|byte| is_space(*byte)) {
            at += 1;
        }
        at
    }

    /// Last byte of a value in quotes that starts here, and the byte after it.
    fn quoted(&self, start: usize) -> Option<(usize, usize)> {
        let bytes = self.content.as_bytes();
        let mut at = start + 1;
        loop {
            match (bytes.get(at)?, bytes.get(at + 1)) {
                _ if at - start > LONGEST_QUOTED => return None,
                (b'"', Some(b'"')) => at += 2,
                (b'"', _) => break,
                _ => at += 1,
            }
        }
        let behind = self.past_spaces(at + 1);
        let is_end = match bytes.get(behind) {
            None | Some(b'\n' | b'\r') => true,
            Some(byte) => {
                self.is_separator(*byte) || (self.separator == Separator::Spaces && behind > at + 1)
            }
        };
        is_end.then_some((at, behind))
    }

    /// Moves past the sign that ends a value at a byte.
    fn step(&mut self, at: usize) {
        let bytes = self.content.as_bytes();
        let mut at = if self.separator == Separator::Spaces { self.past_spaces(at) } else { at };
        if bytes.get(at) == Some(&b'\r') && matches!(bytes.get(at + 1), None | Some(b'\n')) {
            at += 1;
        }
        self.has_ended = matches!(bytes.get(at), None | Some(b'\n'));
        let is_behind_separator = self.separator == Separator::Spaces && !self.has_ended;
        self.at = if is_behind_separator { at } else { (at + 1).min(bytes.len()) };
    }
}

impl<'a> Iterator for Cells<'a> {
    type Item = TextCell<'a>;

    fn next(&mut self) -> Option<TextCell<'a>> {
        if self.has_ended {
            return None;
        }
        let bytes = self.content.as_bytes();
        let start = self.past_spaces(self.at);
        if bytes.get(start) == Some(&b'"')
            && let Some((end, behind)) = self.quoted(start)
        {
            self.step(behind);
            let text = self.content.get(start + 1..end).unwrap_or_default();
            let trimmed = text.trim_start();
            return Some(TextCell {
                text: trimmed.trim_end(),
                start: start + 1 + text.len() - trimmed.len(),
            });
        }
        let mut end = start;
        while let Some(&byte) = bytes.get(end) {
            if byte == b'\n' || self.is_separator(byte) {
                break;
            }
            end += 1;
        }
        let text = self.content.get(start..end).unwrap_or_default().trim_end_matches([' ', '\t', '\r']);
        self.step(end);
        Some(TextCell { text, start })
    }
}
