use phea_dynamics::time_response::Settling;

use super::{CheckedWish, wish_sentence};
use crate::answer::{Object, significant};
use crate::document::Document;

/// A wish in time in the JSON of `check`.
pub(crate) fn wish_row(wish: &CheckedWish) -> Object {
    let (wished, reached) = (wish.check.wished, wish.check.reached);
    let step = |overshoot_percent: f64, settling_time_s: Option<f64>| {
        Object::new()
            .with("overshoot_percent", overshoot_percent)
            .with("settling_time_s", settling_time_s)
            .with("settling_band_percent", wished.settling_band_percent)
    };
    let reason = match reached.settling {
        Settling::Settled { .. } => None,
        Settling::NotSettled { deviation_percent } => {
            Some(format!("does not settle: it stays {} % off", significant(deviation_percent, 3)))
        }
    };
    let reached = step(reached.overshoot_percent, reached.settling.time_s());
    Object::new()
        .with("specification", wish.number)
        .with("limit", wish.key)
        .with("wished", step(wished.overshoot_percent, Some(wished.settling_time_s)))
        .with("reached", reached.maybe("reason", reason))
        .with("met", wish.is_met())
}

/// The section of `check` on wishes in time, with an empty line below; empty if there is no wish.
pub(crate) fn document(wishes: &[CheckedWish]) -> Document {
    let mut out = Document::default();
    if wishes.is_empty() {
        return out;
    }
    out.heading("Tracking limits in time");
    out.sentences(wishes.iter().map(wish_sentence));
    out.gap();
    out
}
