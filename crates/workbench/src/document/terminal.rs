//! A document as plain text: columns are aligned by spaces, so that it can be read, searched and pasted anywhere.

use comfy_table::presets;

use super::{Block, Document, Table};

impl Document {
    /// For a terminal.
    pub fn text(&self) -> String {
        let mut out = String::new();
        // no empty line stands above a heading that follows directly
        let mut directly = true;
        for block in &self.blocks {
            let above = if directly { "" } else { "\n" };
            directly = matches!(block, Block::Heading(_) | Block::Warning(_) | Block::Gap);
            match block {
                Block::Warning(sentence) => out.push_str(&format!("warning: {sentence}\n")),
                Block::Line(text) => out.push_str(&format!("{text}\n")),
                Block::Heading(title) => out.push_str(&format!("{above}{title}\n")),
                Block::HeadingOnPage(_) | Block::Gap => out.push('\n'),
                Block::Verdict { title, sentences, .. } => {
                    out.push_str(&format!("{above}{title}\n"));
                    indented(&mut out, sentences);
                }
                Block::Sentences(sentences) => indented(&mut out, sentences.iter().map(|(_, text)| text)),
                Block::Equations(equations) => indented(&mut out, equations),
                Block::Table(table) | Block::Folded(_, table) | Block::Asked(table) => {
                    out.push_str(&format!("{}\n", table.text()))
                }
                Block::Cards { facts, .. } => {
                    indented(&mut out, facts.iter().map(|(name, words)| format!("{name}: {words}")));
                }
                Block::Callout(_, sentence) => indented(&mut out, [sentence]),
                Block::Steps { title, steps } => {
                    out.push_str(&format!("{above}{title}\n"));
                    indented(&mut out, steps);
                }
                Block::Beside(document) => out.push_str(&document.text()),
                Block::Preformatted(text) => out.push_str(text),
                Block::HeadingOfFigures(_) | Block::Explanation(_) | Block::Figure(_) => {}
            }
        }
        out
    }
}

fn indented(out: &mut String, sentences: impl IntoIterator<Item = impl std::fmt::Display>) {
    for sentence in sentences {
        out.push_str(&format!("  {sentence}\n"));
    }
}

impl Table {
    /// Its lines without the last line break.
    pub(crate) fn text(&self) -> String {
        let mut printed = comfy_table::Table::new();
        printed.load_style(presets::NOTHING);
        printed.set_header(self.grouped_by.iter().chain(&self.headings));
        for group in &self.groups {
            let mut name = group.name.as_str();
            for row in &group.rows {
                let first = self.grouped_by.is_some().then(|| std::mem::take(&mut name).to_string());
                printed.add_row(first.into_iter().chain(row.iter().map(|cell| cell.text())));
            }
        }
        printed.trim_fmt()
    }
}
