//! The page: one HTML file that needs nothing else, on screen, in the dark and on paper.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::chapter::Chapter;
use crate::figure::style_sheet;

/// The whole page from its heading, the chapters and the footer.
pub(super) fn page(title: &str, heading: &Markup, chapters: &[Chapter], footer: &Markup) -> String {
    let style = format!("{}{}", include_str!("style.css"), style_sheet());
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(style)) }
            }
            body {
                (heading)
                nav aria-label="Contents" { ol { @for chapter in chapters { li { a href=(format!("#{}", chapter.anchor)) { (chapter.title) } } } } }
                main {
                    @for chapter in chapters {
                        section id=(chapter.anchor) { h2 { (chapter.title) } (chapter.body) }
                    }
                }
                footer { (footer) }
            }
        }
    }
    .into_string()
}
