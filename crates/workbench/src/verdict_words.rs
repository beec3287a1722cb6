//! Verdicts, agreements, margins and frequencies in words.

use phea_engineering::trial::Agreement;
use phea_qft::verification::Verdict;

use crate::answer::words;
use crate::document::{Cell, frequency_number};

words! {
    /// Verdict on a requirement: satisfied by every plant, violated by one, or not resolved.
    Verdict by verdict_key [Met, Violated, NotProven]
}

/// The word of a verdict in JSON.
pub(crate) fn verdict_key(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Met => "met",
        Verdict::Violated => "violated",
        Verdict::NotProven => "not_proven",
    }
}

/// Words of a verdict for people.
pub(crate) fn verdict_words(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::NotProven => "not proven",
        other => verdict_key(other),
    }
}

/// `at 1304 rad/s`, `towards zero frequency`, `towards infinite frequency`.
pub(crate) fn frequency_words(frequency_rad_per_s: f64) -> String {
    match frequency_rad_per_s {
        0.0 => "towards zero frequency".to_string(),
        f64::INFINITY => "towards infinite frequency".to_string(),
        _ => format!("at {} rad/s", frequency_number(frequency_rad_per_s)),
    }
}

/// The words of an agreement for people.
pub(crate) fn agreement_word(agreement: Agreement) -> &'static str {
    match agreement {
        Agreement::Agrees => "agrees",
        Agreement::AgreesButForSettling => "agrees but for the settling",
        Agreement::Differs => "differs",
        Agreement::Contradicts => "contradicts",
    }
}

impl Cell {
    /// The cell of a verdict.
    pub(crate) fn verdict(verdict: Verdict) -> Cell {
        Cell::from(verdict_words(verdict)).marked(verdict)
    }
}
