//! Requirements in time for programs, and the section of `check` on them.

use phea_dynamics::time_response::Settling;
use phea_engineering::simulate::StepLimits;

use super::{CheckedRequirement, requirement_sentence};
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

impl From<&StepLimits> for RequiredStepAnswer {
    fn from(requirement: &StepLimits) -> Self {
        RequiredStepAnswer {
            overshoot_percent: requirement.overshoot_percent,
            settling_time_s: requirement.settling_time_s,
            rise_time_s: requirement.rise_time_s,
            settling_band_percent: requirement.band_percent,
        }
    }
}

/// Requirement in time of a tracking limit, with the response that the limit itself has.
#[derive(Answer)]
pub(crate) struct CheckedRequirementAnswer {
    /// Number of the specification, from 1 in the order of the file.
    specification: usize,
    /// Key of the limit.
    limit: &'static str,
    /// Required step response.
    required: RequiredResponseAnswer,
    /// Step response of the limit.
    reached: ReachedStepAnswer,
    /// True if the limit satisfies the requirement.
    met: bool,
}

/// Step response.
#[derive(Answer)]
struct RequiredResponseAnswer {
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
    step: RequiredResponseAnswer,
    /// Reason for which there is no settling time.
    #[answer(optional)]
    reason: Option<String>,
}

/// A requirement in time in the JSON of `check`.
pub(crate) fn requirement_answer(requirement: &CheckedRequirement) -> CheckedRequirementAnswer {
    let (required, reached) = (requirement.check.required, requirement.check.reached);
    let step = |overshoot_percent: f64, settling_time_s: Option<f64>| RequiredResponseAnswer {
        overshoot_percent,
        settling_time_s,
        settling_band_percent: required.settling_band_percent,
    };
    let reason = match reached.settling {
        Settling::Settled { .. } => None,
        Settling::NotSettled { deviation_percent } => {
            Some(format!("does not settle: it stays {} % off", significant(deviation_percent, 3)))
        }
    };
    CheckedRequirementAnswer {
        specification: requirement.number,
        limit: requirement.key,
        required: step(required.overshoot_percent, Some(required.settling_time_s)),
        reached: ReachedStepAnswer {
            step: step(reached.overshoot_percent, reached.settling.time_s()),
            reason,
        },
        met: requirement.is_met(),
    }
}

/// The section of `check` on wishes in time, with an empty line below; empty if there is no wish.
pub(crate) fn document(requirements_in_time: &[CheckedRequirement]) -> Document {
    let mut out = Document::default();
    if requirements_in_time.is_empty() {
        return out;
    }
    out.heading("Tracking limits in time");
    out.sentences(requirements_in_time.iter().map(requirement_sentence));
    out.gap();
    out
}
