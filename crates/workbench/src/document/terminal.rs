//! A document as plain text: columns are aligned by spaces, so that it can be read, searched and
//! pasted anywhere.

use comfy_table::presets;

use super::{Block, Cell, Document, Table};

impl Document {
    /// The document as text for a terminal.
    pub fn text(&self) -> String {
        let mut out = String::new();
        // no empty line is printed above a heading that follows directly
        let mut directly = true;
        for block in &self.blocks {
            let above = if directly { "" } else { "\n" };
            directly = matches!(block, Block::Heading(_) | Block::Warning(_) | Block::Gap);
            match block {
                Block::Warning(sentence) => out.push_str(&format!("warning: {sentence}\n")),
                Block::Line(text) => out.push_str(&format!("{text}\n")),
                Block::Heading(title) => out.push_str(&format!("{above}{title}\n")),
                Block::HeadingOnPage(_) | Block::Gap => out.push('\n'),
                Block::Verdict { title, sentences: steps, .. } | Block::Steps { title, steps } => {
                    out.push_str(&format!("{above}{title}\n"));
                    steps.iter().for_each(|step| indented(&mut out, step));
                }
                Block::Sentences(sentences) => {
                    sentences.iter().for_each(|(_, text)| indented(&mut out, text));
                }
                Block::Equations(equations) => {
                    equations.iter().for_each(|equation| indented(&mut out, equation));
                }
                Block::Table(table) | Block::Folded(_, table) | Block::Requests(table) => {
                    out.push_str(&format!("{}\n", table.text()))
                }
                Block::Cards { facts, .. } => facts.iter().for_each(|(name, fact)| {
                    indented(&mut out, &format!("{name}: {fact}"));
                }),
                Block::Callout(_, sentence) => indented(&mut out, sentence),
                Block::SideBySide(document) => out.push_str(&document.text()),
                Block::Preformatted(text) => out.push_str(text),
                Block::HeadingOfFigures(_) | Block::Explanation(_) | Block::Figure(_) | Block::Later(_) => {}
            }
        }
        out
    }
}

fn indented(out: &mut String, sentence: &str) {
    out.push_str(&format!("  {sentence}\n"));
}

impl Table {
    /// The lines of the table without the last line break.
    fn text(&self) -> String {
        let mut printed = comfy_table::Table::new();
        printed.load_style(presets::NOTHING);
        printed.set_header(self.grouped_by.iter().chain(&self.headings));
        for group in &self.groups {
            let mut name = group.name.text();
            for row in &group.rows {
                let first = self.grouped_by.is_some().then(|| std::mem::take(&mut name));
                printed.add_row(first.into_iter().chain(row.iter().map(Cell::text)));
            }
        }
        printed.trim_fmt()
    }
}
