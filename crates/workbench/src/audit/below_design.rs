//! Limits of a design that a given loop satisfies or exceeds, in words and in JSON.

use phea_engineering::audit::ProjectAudit;
use phea_engineering::limit_kind::{DesignLimitKind, ExceededLimit, JudgedLimits, LimitOrigin, limit_key};
use phea_qft::verification::Verdict;

use crate::answer::{Answer, Keyed};
use crate::document::{Cell, Document, Table};
use crate::limit_kind::{LimitKeys, LimitValueKeys, in_limit_unit, limit_words, origin_words};
use crate::quantity::DisplayUnit;

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
        let limit = Cell::from(if least { "at least " } else { "at most " }).then(cell(one.kind, one.limit));
        [
            Cell::from(limit_words(one.kind)),
            Cell::Code(format!("design.{}", limit_key(one.kind))),
            cell(one.kind, one.reached),
            limit,
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
fn cell(kind: DesignLimitKind, value: f64) -> Cell {
    match kind {
        DesignLimitKind::NoiseToCommand => {
            Cell::quantity(value, 3, DisplayUnit::PERCENT).then(" of the nominal voltage")
        }
        DesignLimitKind::HighestBandwidth if value.is_infinite() => "no end of it".into(),
        DesignLimitKind::HighestBandwidth | DesignLimitKind::FastestPole => {
            Cell::quantity(value, 3, DisplayUnit::RADIAN_PER_SECOND)
        }
        DesignLimitKind::MinimumDelayMargin => Cell::quantity(value, 3, DisplayUnit::MILLISECOND),
        DesignLimitKind::ModulusMargin
        | DesignLimitKind::PoleDampingRatio
        | DesignLimitKind::PrefilterGain
        | DesignLimitKind::CommandOfSteps
        | DesignLimitKind::RequiredStep => Cell::number(value, 3),
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
