//! Text for a terminal: words change their length, and the columns of a table still stand below
//! each other.

use crate::quantity::Vocabulary;

/// The same text for a rig that turns.
pub(super) fn said(text: &str, words: &Vocabulary) -> String {
    let lines: Vec<&str> = text.split('\n').collect();
    let blocks = lines.chunk_by(|one, next| one.trim().is_empty() == next.trim().is_empty());
    let said: Vec<String> = blocks.flat_map(|block| aligned(block, words)).collect();
    said.join("\n")
}

/// A part of a line, and where it began.
struct Part {
    begins: usize,
    text: String,
}

/// Lines without an empty one between them: what began in one column still does.
fn aligned(block: &[&str], words: &Vocabulary) -> Vec<String> {
    let lines: Vec<Vec<Part>> = block.iter().map(|line| parts(line, words)).collect();
    let mut columns: Vec<usize> = lines.iter().flatten().map(|part| part.begins).collect();
    columns.sort_unstable();
    columns.dedup();
    let mut moved: Vec<usize> = Vec::with_capacity(columns.len());
    for (index, column) in columns.iter().enumerate() {
        let before = moved.last().copied().unwrap_or(0);
        let ends = lines.iter().filter_map(|line| {
            let next = line.iter().position(|part| part.begins == *column)?;
            let last = line.get(next.checked_sub(1)?)?;
            let place = columns[..index].iter().position(|begins| *begins == last.begins)?;
            Some(last.begins + moved.get(place)? + last.text.chars().count() + 2)
        });
        moved.push(ends.max().map_or(before, |end| before.max(end.saturating_sub(*column))));
    }
    let place = |begins: usize| {
        let index = columns.iter().position(|column| *column == begins);
        begins + index.and_then(|index| moved.get(index)).copied().unwrap_or(0)
    };
    lines.iter().map(|line| laid(line, &place)).collect()
}

fn laid(line: &[Part], place: &dyn Fn(usize) -> usize) -> String {
    let mut out = String::new();
    let mut length = 0;
    for part in line {
        let begins = place(part.begins);
        out.push_str(&" ".repeat(begins.saturating_sub(length)));
        out.push_str(&part.text);
        length = begins.max(length) + part.text.chars().count();
    }
    out
}

/// The parts of a line that two spaces or more separate, in the words of the motion.
fn parts(line: &str, words: &Vocabulary) -> Vec<Part> {
    let mut found = Vec::new();
    let (mut text, mut begins, mut spaces) = (String::new(), 0, 0);
    for (column, letter) in line.chars().enumerate() {
        if letter == ' ' {
            spaces += 1;
            continue;
        }
        if spaces >= 2 && !text.is_empty() {
            found.push(Part { begins, text: words.of(&std::mem::take(&mut text)) });
        }
        if text.is_empty() {
            begins = column;
        } else {
            text.push_str(&" ".repeat(spaces));
        }
        (spaces, _) = (0, text.push(letter));
    }
    if !text.is_empty() {
        found.push(Part { begins, text: words.of(&text) });
    }
    found
}
