//! The page: one self-contained HTML file, for the screen (light or dark) and for paper.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::chapter::Chapter;
use crate::figure::style_sheet;

/// The content of the whole page before it is written.
pub(super) struct Page<'a> {
    pub(super) title: &'a str,
    pub(super) subtitle: &'a str,
    /// The first sheet of paper: the decision.
    pub(super) opening: &'a Chapter,
    pub(super) chapters: &'a [Chapter],
    pub(super) appendix: &'a [Chapter],
    /// SHA-256 of the project.
    pub(super) sha256: &'a str,
}

impl Page<'_> {
    /// Returns the HTML of the page.
    pub(super) fn html(&self) -> String {
        let style = format!("{}{}", include_str!("style.css"), style_sheet());
        html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    title { (self.title) }
                    style { (PreEscaped(style)) }
                }
                body {
                    header { h1 { (self.title) } p.subtitle { (self.subtitle) } }
                    main {
                        section.opening id=(self.opening.anchor) { h2 { (self.opening.title) } (self.opening.document.markup()) }
                        (self.contents())
                        @for chapter in self.chapters { (section(chapter)) }
                        @if !self.appendix.is_empty() { p.part { "Appendix" } }
                        @for chapter in self.appendix { (section(chapter)) }
                    }
                    footer {
                        p { "Made by phea " (env!("CARGO_PKG_VERSION")) " from a project with SHA-256 " code { (self.sha256) } "." }
                        p { "Equations are numbered as in Ledezma (2019), Universidade Federal de Santa Catarina; corrected where its book of errata says so." }
                    }
                }
            }
        }
        .into_string()
    }

    fn contents(&self) -> Markup {
        let links = |chapters: &[Chapter]| html! { @for chapter in chapters { li { a href=(format!("#{}", chapter.anchor)) { (chapter.title) } } } };
        html! {
            nav aria-label="Contents" {
                ol { (links(self.chapters)) }
                @if !self.appendix.is_empty() { p { "Appendix" } ol { (links(self.appendix)) } }
            }
        }
    }
}

fn section(chapter: &Chapter) -> Markup {
    html! { section id=(chapter.anchor) { h2 { (chapter.title) } div.columns { (chapter.document.markup()) } } }
}
