//! A verdict as a mark: a word, a form and a colour, so that none of them is needed alone.

use maud::{Markup, html};
use phea_qft::verification::Verdict;

use crate::audit::verdict_words;
use crate::trial::{Agreement, agreement_word};

/// Good, to be looked at, bad.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mark {
    /// A circle with a tick.
    Good,
    /// A triangle with an exclamation mark.
    Note,
    /// A square with a cross.
    Bad,
}

impl Mark {
    /// Of a verdict.
    pub(super) fn of_verdict(verdict: Verdict) -> Mark {
        match verdict {
            Verdict::Met => Mark::Good,
            Verdict::NotProven => Mark::Note,
            Verdict::Violated => Mark::Bad,
        }
    }

    /// Of what the machine did with a verdict.
    pub(super) fn of_agreement(agreement: Agreement) -> Mark {
        match agreement {
            Agreement::Agrees => Mark::Good,
            Agreement::Differs => Mark::Note,
            Agreement::Contradicts => Mark::Bad,
        }
    }

    /// Of a wish that is kept, missed, or not judged.
    pub(super) fn of_kept(kept: Option<bool>) -> Option<Mark> {
        kept.map(|kept| if kept { Mark::Good } else { Mark::Bad })
    }

    /// The class of its colour, which that of an edge begins with.
    pub(super) fn class(self) -> &'static str {
        match self {
            Mark::Good => "good",
            Mark::Note => "note",
            Mark::Bad => "bad",
        }
    }
}

/// The form with the word in its colour.
pub(super) fn badge(mark: Mark, word: &str) -> Markup {
    html! { span class={ "mark " (mark.class()) } { (form(mark)) (word) } }
}

/// That of a verdict.
pub(super) fn verdict_badge(verdict: Verdict) -> Markup {
    badge(Mark::of_verdict(verdict), verdict_words(verdict))
}

/// That of what the machine did.
pub(super) fn agreement_badge(agreement: Agreement) -> Markup {
    badge(Mark::of_agreement(agreement), agreement_word(agreement))
}

fn form(mark: Mark) -> Markup {
    let (outline, inside) = match mark {
        Mark::Good => ("M8 1a7 7 0 1 1 0 14a7 7 0 1 1 0-14z", "M4.5 8.3l2.4 2.4l4.6-5.2"),
        Mark::Note => ("M8 1.2l7.2 13.2h-14.4z", "M8 6v4.2M8 12v.8"),
        Mark::Bad => ("M1.5 1.5h13v13h-13z", "M5 5l6 6M11 5l-6 6"),
    };
    html! {
        svg viewBox="0 0 16 16" aria-hidden="true" {
            path d=(outline) fill="currentColor" {}
            path d=(inside) fill="none" stroke="var(--paper)" stroke-width="1.9" stroke-linecap="round" {}
        }
    }
}
