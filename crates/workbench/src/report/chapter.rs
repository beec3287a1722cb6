use maud::{Markup, PreEscaped, html};

use super::typeset::prose;
use crate::figure::Figure;

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

/// A figure with its caption, set into a page.
pub(super) fn place(figure: &Figure) -> Markup {
    html! {
        figure {
            (PreEscaped(figure.to_svg_inline()))
            figcaption { b { (figure.title) "." } " " (figure.caption) }
        }
    }
}

/// A table with these headings; the columns from `numbers_from` on hold numbers.
pub(super) fn table(headings: &[&str], numbers_from: usize, rows: &[Vec<Markup>]) -> Markup {
    let class = |column: usize| if column >= numbers_from { "number" } else { "" };
    html! {
        div.table { table {
            thead { tr { @for (column, heading) in headings.iter().enumerate() { th class=(class(column)) { (prose(heading)) } } } }
            tbody { @for row in rows { tr { @for (column, cell) in row.iter().enumerate() { td class=(class(column)) { (cell) } } } } }
        } }
    }
}

/// A plain text as a cell.
pub(super) fn cell(text: impl Into<String>) -> Markup {
    html! { (text.into()) }
}
