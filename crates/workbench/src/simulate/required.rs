//! Requirements in time, compared with the runs of scenarios, in words and for programs.

use super::{
    NotJudged, ReachedStep, ScenarioRequirement, ScenarioRun, reached_words, required_of_run, required_words,
};
use crate::answer::{Answer, OrReason, Word, words};
use crate::project::Project;
use crate::specification::RequiredStepAnswer;

/// Reason why runs give no verdict on a requirement.
pub(crate) fn not_judged_words(why: NotJudged) -> &'static str {
    match why {
        NotJudged::NoStep => "the scenario has no such step of the reference",
        NotJudged::OtherBand => {
            "the scenario measures settling in another band: state its `settling_band_percent` as required"
        }
    }
}

/// Outcome of steps for a requirement in time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Satisfaction {
    /// Every step satisfies it.
    Satisfies,
    /// A step does not.
    Misses,
}

words! {
    /// Outcome of steps for a requirement in time.
    Satisfaction { Satisfies => "satisfies", Misses => "misses" }
}

impl From<bool> for Satisfaction {
    fn from(is_satisfied: bool) -> Satisfaction {
        if is_satisfied { Satisfaction::Satisfies } else { Satisfaction::Misses }
    }
}

/// The word for steps that satisfy what is required in time, or not.
pub(crate) fn satisfied_word(is_satisfied: bool) -> &'static str {
    Satisfaction::from(is_satisfied).word()
}

/// The requirements of the project in a run, each satisfied, missed or not judged, with the worst
/// of its steps.
pub(crate) fn requirement_sentences(project: &Project, run: &ScenarioRun) -> Vec<String> {
    required_of_run(project, run).iter().map(requirement_sentence).collect()
}

/// A requirement in a run, in words that continue the name of the run.
pub(crate) fn requirement_sentence(one: &ScenarioRequirement) -> String {
    let required =
        format!("what specification {} requires, {}", one.number, required_words(&one.step_limits));
    match (one.reached, one.is_satisfied()) {
        (Ok(reached), Some(is_satisfied)) => {
            format!(
                "{} {required}: {}",
                satisfied_word(is_satisfied),
                reached_words(&one.step_limits, &reached)
            )
        }
        (Err(why), _) => format!("does not judge {required}: {}", not_judged_words(why)),
        (Ok(_), None) => required,
    }
}

/// Requirement in time against the steps of a run.
#[derive(Answer)]
pub(super) struct ScenarioRequirementAnswer {
    /// Number of the specification, from 1 in the order of the file.
    specification: usize,
    /// Required step response.
    required: RequiredStepAnswer,
    /// Outcome for the requirement.
    verdict: OrReason<Satisfaction>,
    /// Worst step of the run; null without a verdict.
    reached: Option<WorstStepAnswer>,
}

/// Worst of the steps against a requirement in time.
#[derive(Answer)]
pub(crate) struct WorstStepAnswer {
    /// Overshoot, of the step.
    overshoot_percent: f64,
    /// Settling time; `inf` if the step does not settle.
    settling_time_s: f64,
    /// Rise from 10 to 90 percent; `inf` if the step does not rise so far.
    rise_time_s: f64,
}

impl From<ReachedStep> for WorstStepAnswer {
    fn from(reached: ReachedStep) -> WorstStepAnswer {
        let ReachedStep { overshoot_percent, settling_time_s, rise_time_s } = reached;
        WorstStepAnswer { overshoot_percent, settling_time_s, rise_time_s }
    }
}

/// The same for programs.
pub(super) fn requirement(one: &ScenarioRequirement) -> ScenarioRequirementAnswer {
    let satisfied = one.reached.map(|reached| one.step_limits.is_satisfied(&reached).into());
    ScenarioRequirementAnswer {
        specification: one.number,
        required: (&one.step_limits).into(),
        verdict: OrReason(satisfied.map_err(|why| not_judged_words(why).to_string())),
        reached: one.reached.ok().map(WorstStepAnswer::from),
    }
}
