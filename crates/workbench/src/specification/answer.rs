//! Requirements in time for programs, and the section of `check` on them.

use phea_dynamics::time_response::Settling;
use phea_engineering::simulate::TrackingWish;

use super::{CheckedWish, wish_sentence};
use crate::answer::{Answer, significant, words};
use crate::document::Document;
use crate::project::{SPECIFICATION_KINDS, SpecificationKind};

words! {
    /// Kind of a specification, as in the project file.
    SpecificationKind in SPECIFICATION_KINDS
}

/// Required response to a step of the reference.
#[derive(Answer)]
pub(crate) struct RequiredStepAnswer {
    /// Greatest overshoot, of the step.
    #[answer(optional)]
    overshoot_percent: Option<f64>,
    /// Longest settling time.
    #[answer(optional)]
    settling_time_s: Option<f64>,
    /// Longest rise from 10 to 90 percent.
    #[answer(optional)]
    rise_time_s: Option<f64>,
    /// Band in which the response has settled, of the step.
    settling_band_percent: f64,
}

impl From<&TrackingWish> for RequiredStepAnswer {
    fn from(wish: &TrackingWish) -> Self {
        RequiredStepAnswer {
            overshoot_percent: wish.overshoot_percent,
            settling_time_s: wish.settling_time_s,
            rise_time_s: wish.rise_time_s,
            settling_band_percent: wish.band_percent,
        }
    }
}

/// Requirement in time of a tracking limit, with the response that the limit itself has.
#[derive(Answer)]
pub(crate) struct WishAnswer {
    /// Number of the specification, from 1 in the order of the file.
    specification: usize,
    /// Key of the limit.
    limit: &'static str,
    /// Required step response.
    wished: WishedStepAnswer,
    /// Step response of the limit.
    reached: ReachedStepAnswer,
    /// True if the limit satisfies the requirement.
    met: bool,
}

/// Step response.
#[derive(Answer)]
struct WishedStepAnswer {
    /// Overshoot, of the step.
    overshoot_percent: f64,
    /// Settling time; null if the response does not settle.
    settling_time_s: Option<f64>,
    /// Band in which the response has settled, of the step.
    settling_band_percent: f64,
}

/// Step response of a limit.
#[derive(Answer)]
struct ReachedStepAnswer {
    #[answer(flatten)]
    step: WishedStepAnswer,
    /// Reason for which there is no settling time.
    #[answer(optional)]
    reason: Option<String>,
}

/// A wish in time in the JSON of `check`.
pub(crate) fn wish_answer(wish: &CheckedWish) -> WishAnswer {
    let (wished, reached) = (wish.check.wished, wish.check.reached);
    let step = |overshoot_percent: f64, settling_time_s: Option<f64>| WishedStepAnswer {
        overshoot_percent,
        settling_time_s,
        settling_band_percent: wished.settling_band_percent,
    };
    let reason = match reached.settling {
        Settling::Settled { .. } => None,
        Settling::NotSettled { deviation_percent } => {
            Some(format!("does not settle: it stays {} % off", significant(deviation_percent, 3)))
        }
    };
    WishAnswer {
        specification: wish.number,
        limit: wish.key,
        wished: step(wished.overshoot_percent, Some(wished.settling_time_s)),
        reached: ReachedStepAnswer {
            step: step(reached.overshoot_percent, reached.settling.time_s()),
            reason,
        },
        met: wish.is_met(),
    }
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
