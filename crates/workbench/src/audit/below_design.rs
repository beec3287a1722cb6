//! Limits of a design that a given loop satisfies or exceeds, in words and in JSON.

use phea_engineering::limit_kind::{DesignLimitKind, ExceededLimit, JudgedLimits, LimitOrigin, limit_key};
use phea_qft::verification::Verdict;

use super::ProjectAudit;
use crate::answer::{Answer, Keyed};
use crate::document::{Cell, Document, Table};
use crate::limit_kind::{LimitKeys, LimitValueKeys, in_limit_unit, limit_words, origin_words};
use crate::quantity::{DisplayUnit, significant};

/// A table of the limits that the loop exceeds, with their meaning, or a statement that it
/// satisfies all; empty if none was judged.
pub(super) fn document(view: &ProjectAudit) -> Document {
    let mut out = Document::default();
    let Some(JudgedLimits { exceeded, satisfied }) = &view.below_design else { return out };
    if exceeded.is_empty() {
        let words: Vec<&str> = satisfied.iter().map(|kind| limit_words(*kind)).collect();
        out.sentences((!words.is_empty()).then(|| {
            format!(
                "the loop keeps every limit of `[design]` that a given loop is held against, stated or by default: {}",
                words.join(", ")
            )
        }));
        return out;
    }
    let row = |one: &ExceededLimit| {
        let least = matches!(one.kind, DesignLimitKind::ModulusMargin | DesignLimitKind::MinimumDelayMargin);
        let limit = format!("at {} {}", if least { "least" } else { "most" }, words(one.kind, one.limit));
        [
            Cell::from(limit_words(one.kind)),
            Cell::Code(format!("design.{}", limit_key(one.kind))),
            words(one.kind, one.reached).into(),
            limit.into(),
            origin_words(one.origin).into(),
        ]
    };
    let table = Table::new(["limit", "key", "worst of the family", "required", "from"]);
    out.section("Below what a design must keep", table.with(exceeded.iter().map(row)));
    let lead = match view.verdict() {
        Verdict::Met => "The specifications are met, but `phea design` would refuse this loop",
        Verdict::Violated | Verdict::NotProven => "`phea design` would refuse this loop for these limits too",
    };
    out.sentences([format!(
        "{lead}: a loop that is to be built keeps them, as `[design]` states them or by default. They are no part of the verdict."
    )]);
    let has_bandwidth = exceeded.iter().any(|one| one.kind == DesignLimitKind::HighestBandwidth);
    out.sentences(has_bandwidth.then(|| {
        "The bandwidth is the frequency above which |L/(1+L)| of every plant stays below -3 dB.".to_string()
    }));
    out
}

/// The value of a limit with its unit.
fn words(kind: DesignLimitKind, value: f64) -> String {
    match kind {
        DesignLimitKind::NoiseToCommand => {
            format!("{} % of the nominal voltage", significant(100.0 * value, 3))
        }
        DesignLimitKind::HighestBandwidth if value.is_infinite() => "no end of it".to_string(),
        DesignLimitKind::HighestBandwidth | DesignLimitKind::FastestPole => {
            format!("{} rad/s", significant(value, 3))
        }
        DesignLimitKind::MinimumDelayMargin => DisplayUnit::MILLISECOND.text(value, 3),
        DesignLimitKind::ModulusMargin
        | DesignLimitKind::PoleDampingRatio
        | DesignLimitKind::PrefilterGain
        | DesignLimitKind::CommandOfSteps
        | DesignLimitKind::RequiredStep => significant(value, 3),
    }
}

/// Limit of a design that an audited loop exceeds.
#[derive(Answer)]
pub(super) struct ExceededLimitAnswer {
    /// Limit in `[design]`.
    key: DesignLimitKind,
    #[answer(flatten)]
    value: Keyed<LimitValueKeys, f64>,
    #[answer(flatten)]
    limit: Keyed<LimitKeys, f64>,
    /// Origin of the limit.
    origin: LimitOrigin,
}

/// A limit in JSON, its numbers in SI.
pub(super) fn answer(one: &ExceededLimit) -> ExceededLimitAnswer {
    ExceededLimitAnswer {
        key: one.kind,
        value: in_limit_unit(one.kind, one.reached),
        limit: in_limit_unit(one.kind, one.limit),
        origin: one.origin,
    }
}
