use phea_dynamics::time_response::Settling;
use serde::Serialize;

use super::CheckedWish;
use crate::answer::significant;

/// A wish in time in the JSON of `check`.
#[derive(Serialize)]
pub(crate) struct WishRow {
    specification: usize,
    limit: &'static str,
    wished: StepLimitAnswer,
    reached: StepLimitAnswer,
    met: bool,
}

#[derive(Serialize)]
struct StepLimitAnswer {
    overshoot_percent: f64,
    settling_time_s: Option<f64>,
    settling_band_percent: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
}

impl WishRow {
    pub(crate) fn of(wish: &CheckedWish) -> WishRow {
        let (wished, reached) = (wish.check.wished, wish.check.reached);
        let reason = match reached.settling {
            Settling::Settled { .. } => None,
            Settling::NotSettled { deviation_percent } => {
                Some(format!("does not settle: it stays {} % off", significant(deviation_percent, 3)))
            }
        };
        WishRow {
            specification: wish.number,
            limit: wish.key,
            wished: StepLimitAnswer {
                overshoot_percent: wished.overshoot_percent,
                settling_time_s: Some(wished.settling_time_s),
                settling_band_percent: wished.settling_band_percent,
                reason: None,
            },
            reached: StepLimitAnswer {
                overshoot_percent: reached.overshoot_percent,
                settling_time_s: reached.settling.time_s(),
                settling_band_percent: wished.settling_band_percent,
                reason,
            },
            met: wish.is_met(),
        }
    }
}

/// The section of `check` on wishes in time, with an empty line below; nothing where there is no wish.
pub(crate) fn text(wishes: &[CheckedWish]) -> String {
    if wishes.is_empty() {
        return String::new();
    }
    let line = |wish: &CheckedWish| {
        let met = if wish.is_met() { "met" } else { "not met" };
        format!("  Specification {}, {} limit, {met}; {}.\n", wish.number, wish.key, wish.check)
    };
    let lines: String = wishes.iter().map(line).collect();
    format!("Tracking limits in time\n{lines}\n")
}
