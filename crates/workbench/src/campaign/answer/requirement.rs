//! A requirement in time over the runs of a campaign.

use phea_engineering::campaign::{CampaignRequirement, SatisfiedRuns};

use crate::answer::{Answer, OrReason};
use crate::simulate::{WorstStepAnswer, not_judged_words, required_words};
use crate::specification::RequiredStepAnswer;

/// Requirement in time, with the number of runs that satisfy it.
#[derive(Answer)]
pub(super) struct CampaignRequirementAnswer {
    /// Number of the specification, from 1 in the order of the file.
    specification: usize,
    /// Requirement in words.
    requirement: String,
    /// Required step response.
    required: RequiredStepAnswer,
    /// Number of runs all of whose steps satisfy it.
    satisfied: OrReason<usize>,
    /// Number of simulated runs; one that is not completed does not satisfy it.
    runs: OrReason<usize>,
    /// Confidence interval of 95 % for the probability that a run satisfies it, from low to high,
    /// by Wilson.
    #[answer(interval)]
    confidence_95: OrReason<[f64; 2]>,
    /// Run that is furthest from the requirement, if there is a run.
    #[answer(optional)]
    worst: Option<FurthestRunAnswer>,
}

/// Run that is furthest from a requirement in time.
#[derive(Answer)]
struct FurthestRunAnswer {
    /// Index of the run, from 0.
    run: u64,
    /// Worst step of the run.
    reached: WorstStepAnswer,
}

/// The number of runs that satisfy a requirement in time, or the reason why it is not known.
pub(super) fn requirement(one: &CampaignRequirement) -> CampaignRequirementAnswer {
    let worst = one.judged.ok().and_then(|judged| judged.worst);
    CampaignRequirementAnswer {
        specification: one.number,
        requirement: required_words(&one.step_limits),
        required: (&one.step_limits).into(),
        satisfied: judged(one, |judged| judged.satisfied),
        runs: judged(one, |judged| judged.runs),
        confidence_95: judged(one, |judged| judged.confidence_95()),
        worst: worst.map(|(run, reached)| FurthestRunAnswer { run, reached: reached.into() }),
    }
}

fn judged<Value>(one: &CampaignRequirement, value: fn(SatisfiedRuns) -> Value) -> OrReason<Value> {
    OrReason(one.judged.map(value).map_err(|why| not_judged_words(why).to_string()))
}
