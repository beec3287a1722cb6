//! A document as a part of a page.

use maud::{Markup, PreEscaped, html};

use super::typeset::coded;
use super::typeset::unit;
use super::{Block, Cell, Document, StatusMark, Table, prose, typeset};
use crate::figure::Figure;

/// Number of columns from which a table takes the whole width of the paper. A table with a cell
/// that is not broken always does: an equation, or a mark of more letters than [`LONG_MARK`].
const WIDE: usize = 5;

/// Number of letters of a mark that fits into a column of half of the paper.
const LONG_MARK: usize = 24;

impl Document {
    /// The document as a fragment of a page, without a style: headings, paragraphs, tables and
    /// figures.
    pub fn html(&self) -> String {
        self.markup().into_string()
    }

    /// The document as HTML.
    pub(crate) fn markup(&self) -> Markup {
        html! { @for block in &self.blocks { (block.markup()) } }
    }
}

impl Block {
    fn markup(&self) -> Markup {
        match self {
            Block::Heading(title) | Block::HeadingOnPage(title) | Block::HeadingOfFigures(title) => {
                html! { h3 { (prose(title)) } }
            }
            Block::Warning(sentence) => Block::Callout(StatusMark::Note, sentence.clone()).markup(),
            Block::Line(text) => html! { p { (coded(text)) } },
            Block::Gap => Markup::default(),
            Block::Verdict { mark, title, sentences } => html! {
                div class={ "callout " (mark.class()) "-edge" } {
                    p { b { (prose(title)) "." } }
                    @if !sentences.is_empty() { ul { @for sentence in sentences { li { (coded(sentence)) } } } }
                }
            },
            Block::Explanation(text) => html! { p { (coded(text)) } },
            Block::Sentences(sentences) => html! {
                ul { @for (mark, sentence) in sentences {
                    li { @if let Some(mark) = mark { (badge(*mark, "")) } (coded(sentence)) }
                } }
            },
            Block::Equations(equations) => {
                html! { ul.equations { @for equation in equations { li { (typeset(equation)) } } } }
            }
            Block::Table(table) => table.markup(),
            Block::Figure(figure) => place(figure),
            Block::Requests(table) => html! { div.verdicts { (table.markup()) } },
            Block::Cards { facts, are_results } => html! {
                dl.facts.results[*are_results] {
                    @for (name, words) in facts { div.fact { dt { (name) } dd { (carded(words)) } } }
                }
            },
            Block::Callout(mark, sentence) => {
                html! { div class={ "callout " (mark.class()) "-edge" } { p { (prose(sentence)) } } }
            }
            Block::Steps { title, steps } => html! {
                div { h3 { (title) } ol.next { @for step in steps { li { (coded(step)) } } } }
            },
            Block::SideBySide(document) => html! { div.pair { (document.markup()) } },
            Block::Folded(summary, table) => html! { details { summary { (summary) } (table.markup()) } },
            Block::Preformatted(text) => html! { pre { (text) } },
            Block::Later(later) => later.blocks().markup(),
        }
    }
}

impl Table {
    fn markup(&self) -> Markup {
        let parts = self.parts();
        html! { @for part in &parts { (self.part(part)) } }
    }

    /// The table with these columns, as HTML.
    fn part(&self, columns: &[usize]) -> Markup {
        let is_long = |cell: &Cell| match cell {
            Cell::Equation(_) => true,
            Cell::Status(_, marked) => marked.text().chars().count() > LONG_MARK,
            _ => false,
        };
        let wide = columns.len() >= WIDE || self.rows().flatten().any(is_long);
        let numeric: Vec<(usize, bool)> =
            columns.iter().map(|column| (*column, self.is_numeric(*column))).collect();
        html! {
            div.table.wide[wide] { table {
                thead { tr { @for (is_number, heading) in placed(&self.headings, &numeric) { th.number[is_number] { (breakable(heading)) } } } }
                @for group in &self.groups {
                    tbody.group[self.grouped_by.is_some()] {
                        @if self.grouped_by.is_some() { tr { th colspan=(columns.len()) { (group.name.markup()) } } }
                        @for row in &group.rows { tr { @for (is_number, cell) in placed(row, &numeric) { td.number[is_number] { (cell.markup()) } } } }
                    }
                }
            } }
        }
    }
}

/// The items of these columns, each with true if its column is numeric.
fn placed<'i, Item>(items: &'i [Item], columns: &[(usize, bool)]) -> Vec<(bool, &'i Item)> {
    columns.iter().filter_map(|(column, is_number)| Some((*is_number, items.get(*column)?))).collect()
}

/// The words of a card; long names may be broken at their joints.
fn carded(words: &str) -> Markup {
    PreEscaped(prose(words).into_string().replace('_', "_<wbr>"))
}

/// A text in which long names may be broken at their joints, but no unit of torque.
fn breakable(text: &str) -> Markup {
    let broken = prose(text).into_string().replace('_', "_<wbr>").replace('.', ".<wbr>");
    PreEscaped(broken.replace("N.<wbr>m", "N.m"))
}

impl Cell {
    /// The block as HTML.
    fn markup(&self) -> Markup {
        match self {
            Cell::Text(text) => coded(text),
            Cell::Code(text) => html! { code { (breakable(text)) } },
            Cell::Name { words, symbol, .. } => html! { span.symbol { (typeset(symbol)) } (prose(words)) },
            Cell::Unit(text) => html! { span.unit { (unit(text)) } },
            Cell::Equation(equation) => typeset(equation),
            Cell::Status(mark, cell) => badge(*mark, &cell.text()),
            Cell::Strong(cell) => html! { b { (cell.markup()) } },
            Cell::Joined(cells) => html! { @for cell in cells { (cell.markup()) } },
            Cell::Number(_) | Cell::Count(_) | Cell::Missing => prose(&self.text()),
        }
    }
}

/// A figure with its caption.
fn place(figure: &Figure) -> Markup {
    html! {
        figure {
            (PreEscaped(figure.to_svg_inline()))
            figcaption { b { (figure.title) "." } " " (figure.caption) }
        }
    }
}

impl StatusMark {
    /// The class of its colour; the class of an edge begins with it.
    fn class(self) -> &'static str {
        match self {
            StatusMark::Good => "good",
            StatusMark::Note => "note",
            StatusMark::Bad => "bad",
        }
    }
}

/// The symbol with the word in its colour.
fn badge(mark: StatusMark, word: &str) -> Markup {
    let (outline, inside) = match mark {
        StatusMark::Good => ("M8 1a7 7 0 1 1 0 14a7 7 0 1 1 0-14z", "M4.5 8.3l2.4 2.4l4.6-5.2"),
        StatusMark::Note => ("M8 1.2l7.2 13.2h-14.4z", "M8 6v4.2M8 12v.8"),
        StatusMark::Bad => ("M1.5 1.5h13v13h-13z", "M5 5l6 6M11 5l-6 6"),
    };
    html! {
        span class={ "mark " (mark.class()) } {
            svg viewBox="0 0 16 16" aria-hidden="true" {
                path d=(outline) fill="currentColor" {}
                path d=(inside) fill="none" stroke="var(--paper)" stroke-width="1.9" stroke-linecap="round" {}
            }
            (word)
        }
    }
}
