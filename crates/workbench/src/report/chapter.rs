use maud::{Markup, html};

use crate::caveat::of_models;
pub(super) use crate::document::place;
use crate::document::prose;
use crate::document::{Document, StatusMark};
use crate::figure::Figure;
use crate::project::Project;

/// One chapter of the report.
pub struct Chapter {
    /// Anchor of the chapter on the page.
    pub anchor: &'static str,
    /// Heading.
    pub title: &'static str,
    /// Content below the heading.
    pub body: Markup,
    /// Its figures, in the order in which the body shows them.
    pub figures: Vec<Figure>,
}

impl Chapter {
    /// With what a document says.
    pub(super) fn of(anchor: &'static str, title: &'static str, document: Document) -> Chapter {
        Chapter { anchor, title, body: document.markup(), figures: document.into_figures() }
    }
}

/// Columns from which a table takes the whole width of the paper.
const WIDE: usize = 5;

fn table_class(headings: &[&str]) -> &'static str {
    if headings.len() >= WIDE { "table wide" } else { "table" }
}

/// A table in groups of rows, each below its own heading line; the columns from `numbers_from` on hold numbers.
pub(super) fn grouped(
    headings: &[&str],
    numbers_from: usize,
    groups: &[(String, Vec<Vec<Markup>>)],
) -> Markup {
    let class = |column: usize| if column >= numbers_from { "number" } else { "" };
    html! {
        div class=(table_class(headings)) { table {
            thead { tr { @for (column, heading) in headings.iter().enumerate() { th class=(class(column)) { (prose(heading)) } } } }
            @for (name, rows) in groups {
                tbody.group {
                    tr { th colspan=(headings.len()) { (prose(name)) } }
                    @for row in rows { tr { @for (column, cell) in row.iter().enumerate() { td class=(class(column)) { (cell) } } } }
                }
            }
        } }
    }
}

impl Document {
    /// The effects that a chapter on the linear loop does not include, if any.
    pub(super) fn left_out(&mut self, project: &Project) {
        for sentence in of_models(project) {
            self.verdict(StatusMark::Note, sentence, vec![]);
        }
    }
}

/// A plain text as a cell.
pub(super) fn cell(text: impl Into<String>) -> Markup {
    html! { (text.into()) }
}
