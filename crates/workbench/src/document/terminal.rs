//! A document as plain text: columns are aligned by spaces, so that it can be read, searched and
//! pasted anywhere.

use comfy_table::presets;

use super::{Block, Document, Table};
use crate::motion::Vocabulary;

impl Document {
    /// For a terminal.
    pub fn text(&self) -> String {
        self.text_in(&Vocabulary::default())
    }

    /// The same in these words.
    pub(crate) fn text_in(&self, words: &Vocabulary) -> String {
        let mut out = String::new();
        // no empty line stands above a heading that follows directly
        let mut directly = true;
        for block in &self.blocks {
            let above = if directly { "" } else { "\n" };
            directly = matches!(block, Block::Heading(_) | Block::Warning(_) | Block::Gap);
            match block {
                Block::Warning(sentence) => out.push_str(&format!("warning: {}\n", words.of(sentence))),
                Block::Line(text) => out.push_str(&format!("{}\n", words.of(text))),
                Block::Heading(title) => out.push_str(&format!("{above}{}\n", words.of(title))),
                Block::HeadingOnPage(_) | Block::Gap => out.push('\n'),
                Block::Verdict { title, sentences: steps, .. } | Block::Steps { title, steps } => {
                    out.push_str(&format!("{above}{}\n", words.of(title)));
                    steps.iter().for_each(|step| indented(&mut out, words.of(step)));
                }
                Block::Sentences(sentences) => {
                    sentences.iter().for_each(|(_, text)| indented(&mut out, words.of(text)));
                }
                Block::Equations(equations) => {
                    equations.iter().for_each(|equation| indented(&mut out, words.of(equation)));
                }
                Block::Table(table) | Block::Folded(_, table) | Block::Asked(table) => {
                    out.push_str(&format!("{}\n", table.text_in(words)))
                }
                Block::Cards { facts, .. } => facts.iter().for_each(|(name, fact)| {
                    indented(&mut out, words.of(&format!("{name}: {fact}")));
                }),
                Block::Callout(_, sentence) => indented(&mut out, words.of(sentence)),
                Block::Beside(document) => out.push_str(&document.text_in(words)),
                Block::Preformatted(text) => {
                    text.split_inclusive('\n').for_each(|line| out.push_str(&words.of(line)));
                }
                Block::HeadingOfFigures(_) | Block::Explanation(_) | Block::Figure(_) => {}
            }
        }
        out
    }
}

fn indented(out: &mut String, sentence: String) {
    out.push_str(&format!("  {sentence}\n"));
}

impl Table {
    /// Its lines without the last line break.
    fn text_in(&self, words: &Vocabulary) -> String {
        let mut printed = comfy_table::Table::new();
        printed.load_style(presets::NOTHING);
        printed.set_header(self.grouped_by.iter().chain(&self.headings).map(|heading| words.of(heading)));
        for group in &self.groups {
            let mut name = words.of(&group.name);
            for row in &group.rows {
                let first = self.grouped_by.is_some().then(|| std::mem::take(&mut name));
                printed.add_row(first.into_iter().chain(row.iter().map(|cell| words.of(&cell.text()))));
            }
        }
        printed.trim_fmt()
    }
}
