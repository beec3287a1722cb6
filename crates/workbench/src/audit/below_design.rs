//! The limits of a design that a given loop does not keep, in words and in JSON.

use phea_engineering::limit_kind::{
    DesignLimitKind, ExceededLimit, limit_key, limit_unit_key, limit_words, origin_key, origin_words,
};
use phea_qft::verification::Verdict;

use super::ProjectAudit;
use crate::answer::Object;
use crate::document::{Cell, Document, Table};
use crate::quantity::{DisplayUnit, significant};

/// A table of them, and what it means for the loop; empty where there are none.
pub(super) fn document(view: &ProjectAudit) -> Document {
    let mut out = Document::default();
    let exceeded = view.below_design.as_deref().unwrap_or_default();
    if exceeded.is_empty() {
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

/// A limit in JSON, its numbers in SI.
pub(super) fn object(one: &ExceededLimit) -> Object {
    let unit = limit_unit_key(one.kind);
    Object::new()
        .with("key", limit_key(one.kind))
        .with(format!("value{unit}"), one.reached)
        .with(format!("limit{unit}"), one.limit)
        .with("origin", origin_key(one.origin))
}
