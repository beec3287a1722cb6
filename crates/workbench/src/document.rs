//! A result, written once for all readers: headings, sentences, tables of typed cells, figures. A
//! procedure builds the tree; the terminal and the page print it.

mod cell;
mod later;
mod number;
mod page;
mod table;
mod terminal;
mod typeset;

pub(crate) use cell::{Cell, StatusMark};
pub use number::PrintedNumber;
pub(crate) use number::{frequency_number, margin_words};
pub(crate) use table::Table;
pub(crate) use typeset::capital;
pub use typeset::{prose, typeset};

use crate::figure::Figure;
use later::LaterBlocks;

/// Blocks in the order in which they are read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    blocks: Vec<Block>,
}

/// A part of a document. In every text, words such as `K_H` are symbols, and text between backticks
/// is code.
#[derive(Clone, Debug, PartialEq)]
enum Block {
    /// A sentence printed before everything else.
    Warning(String),
    /// A line of text.
    Line(String),
    /// An empty line of a terminal.
    Gap,
    /// Begins a section.
    Heading(String),
    /// A heading of the page, for which a terminal prints only an empty line.
    HeadingOnPage(String),
    /// A heading above figures.
    HeadingOfFigures(String),
    /// Begins a section with its result; the sentences give the reasons.
    Verdict { mark: StatusMark, title: String, sentences: Vec<String> },
    /// Explanations only for readers of the page.
    Explanation(String),
    /// A sentence each, the decisive ones with a mark.
    Sentences(Vec<(Option<StatusMark>, String)>),
    /// Equations, one in each line.
    Equations(Vec<String>),
    /// Rows of cells.
    Table(Table),
    /// A figure, shown on the page only.
    Figure(Box<Figure>),
    /// Details that the page shows on request.
    Folded(String, Table),
    /// Requests and their outcomes: the first column has the words.
    Requests(Table),
    /// Facts by name, each on a card; those of results are small on paper.
    Cards { facts: Vec<(String, String)>, are_results: bool },
    /// A sentence that must not be overlooked.
    Callout(StatusMark, String),
    /// Steps to take, in this order, below their title.
    Steps { title: String, steps: Vec<String> },
    /// Blocks that the page shows side by side.
    SideBySide(Document),
    /// Lines that are printed unchanged.
    Preformatted(String),
    /// Blocks of the page that are made when it is.
    Later(LaterBlocks),
}

impl Document {
    /// Adds sentences that are printed before everything else.
    pub(crate) fn warnings(&mut self, sentences: impl IntoIterator<Item = String>) {
        self.blocks.extend(sentences.into_iter().map(Block::Warning));
    }

    /// A line of text.
    pub(crate) fn line(&mut self, text: impl Into<String>) {
        self.blocks.push(Block::Line(text.into()));
    }

    /// An empty line of a terminal.
    pub(crate) fn gap(&mut self) {
        self.blocks.push(Block::Gap);
    }

    /// Begins a section.
    pub(crate) fn heading(&mut self, title: impl Into<String>) {
        self.blocks.push(Block::Heading(title.into()));
    }

    /// Begins a section that a terminal separates only by an empty line.
    pub(crate) fn heading_on_page(&mut self, title: impl Into<String>) {
        self.blocks.push(Block::HeadingOnPage(title.into()));
    }

    /// Begins a section with its result.
    pub(crate) fn verdict(&mut self, mark: StatusMark, title: impl Into<String>, sentences: Vec<String>) {
        self.blocks.push(Block::Verdict { mark, title: title.into(), sentences });
    }

    /// A paragraph that a terminal leaves out.
    pub(crate) fn explanation(&mut self, text: impl Into<String>) {
        self.blocks.push(Block::Explanation(text.into()));
    }

    /// Paragraphs that a terminal leaves out.
    pub(crate) fn explanations(&mut self, texts: impl IntoIterator<Item = String>) {
        self.blocks.extend(texts.into_iter().map(Block::Explanation));
    }

    /// A sentence each.
    pub(crate) fn sentences(&mut self, sentences: impl IntoIterator<Item = String>) {
        self.marked(sentences.into_iter().map(|sentence| (None, sentence)));
    }

    /// Sentences, some of them with a mark.
    pub(crate) fn marked(&mut self, sentences: impl IntoIterator<Item = (Option<StatusMark>, String)>) {
        let sentences: Vec<_> = sentences.into_iter().collect();
        if !sentences.is_empty() {
            self.blocks.push(Block::Sentences(sentences));
        }
    }

    /// Equations, one in each line.
    pub(crate) fn equations(&mut self, equations: Vec<String>) {
        self.blocks.push(Block::Equations(equations));
    }

    /// A table.
    pub(crate) fn table(&mut self, table: Table) {
        self.blocks.push(Block::Table(table));
    }

    /// Tables; those without rows are omitted.
    pub(crate) fn tables(&mut self, tables: impl IntoIterator<Item = Table>) {
        self.blocks.extend(tables.into_iter().filter(|table| !table.is_empty()).map(Block::Table));
    }

    /// A table below its heading; omitted if it has no rows.
    pub(crate) fn section(&mut self, title: impl Into<String>, table: Table) {
        if !table.is_empty() {
            self.heading(title);
            self.table(table);
        }
    }

    /// A table that the page shows on request.
    pub(crate) fn folded(&mut self, summary: impl Into<String>, table: Table) {
        self.blocks.push(Block::Folded(summary.into(), table));
    }

    /// A table of requests and their outcomes; omitted if it has no rows.
    pub(crate) fn requests(&mut self, table: Table) {
        if !table.is_empty() {
            self.blocks.push(Block::Requests(table));
        }
    }

    /// Facts by name, each on a card.
    pub(crate) fn cards(&mut self, facts: Vec<(String, String)>, are_results: bool) {
        if !facts.is_empty() {
            self.blocks.push(Block::Cards { facts, are_results });
        }
    }

    /// Sentences that must not be overlooked.
    pub(crate) fn callouts(&mut self, mark: StatusMark, sentences: impl IntoIterator<Item = String>) {
        self.blocks.extend(sentences.into_iter().map(|sentence| Block::Callout(mark, sentence)));
    }

    /// Steps to take, in this order; omitted if there are none.
    pub(crate) fn steps(&mut self, title: &str, steps: Vec<String>) {
        if !steps.is_empty() {
            self.blocks.push(Block::Steps { title: title.to_string(), steps });
        }
    }

    /// The blocks of another document, side by side on a page.
    pub(crate) fn side_by_side(&mut self, blocks: Document) {
        self.blocks.push(Block::SideBySide(blocks));
    }

    /// Figures, which a terminal leaves out.
    pub(crate) fn figures(&mut self, figures: impl IntoIterator<Item = Figure>) {
        self.blocks.extend(figures.into_iter().map(|figure| Block::Figure(Box::new(figure))));
    }

    /// Figures below their heading; a terminal leaves out both.
    pub(crate) fn figures_below(&mut self, title: &str, figures: Vec<Figure>) {
        if !figures.is_empty() {
            self.blocks.push(Block::HeadingOfFigures(title.to_string()));
            self.figures(figures);
        }
    }

    /// Lines that are printed unchanged.
    pub(crate) fn preformatted(&mut self, text: impl Into<String>) {
        self.blocks.push(Block::Preformatted(text.into()));
    }

    /// Blocks of the page that are made when it is; a terminal leaves them out.
    pub(crate) fn later(&mut self, make: impl FnOnce() -> Document + Send + 'static) {
        self.blocks.push(Block::Later(LaterBlocks::new(make)));
    }

    /// Appends another document.
    pub(crate) fn append(&mut self, other: Document) {
        self.blocks.extend(other.blocks);
    }

    /// The figures of the document, in order.
    pub(crate) fn into_figures(self) -> Vec<Figure> {
        let figures = self.blocks.into_iter().flat_map(|block| match block {
            Block::Figure(figure) => vec![*figure],
            Block::SideBySide(document) => document.into_figures(),
            Block::Later(later) => later.blocks().clone().into_figures(),
            _ => vec![],
        });
        figures.collect()
    }
}
