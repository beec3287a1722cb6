//! Requirements in time, compared with the runs of scenarios, in words and for programs.

use super::{NotJudged, ScenarioRequirement, ScenarioRun, reached_words, required_of_run, required_words};
use crate::answer::{Object, Word, words};
use crate::project::Project;

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
    let required = format!("what specification {} requires, {}", one.number, required_words(&one.wish));
    match (one.reached, one.is_satisfied()) {
        (Ok(reached), Some(is_satisfied)) => {
            format!("{} {required}: {}", satisfied_word(is_satisfied), reached_words(&one.wish, &reached))
        }
        (Err(why), _) => format!("does not judge {required}: {}", not_judged_words(why)),
        (Ok(_), None) => required,
    }
}

/// A requirement in a run, for programs.
pub(super) fn row(one: &ScenarioRequirement) -> Object {
    let required = &one.wish;
    let required = Object::new()
        .maybe("overshoot_percent", required.overshoot_percent)
        .maybe("settling_time_s", required.settling_time_s)
        .maybe("rise_time_s", required.rise_time_s)
        .with("settling_band_percent", required.band_percent);
    let object = Object::new().with("specification", one.number).with("required", required);
    match one.reached {
        Ok(reached) => object
            .maybe("verdict", one.is_satisfied().map(satisfied_word))
            .with("overshoot_percent", reached.overshoot_percent)
            .with("settling_time_s", reached.settling_time_s)
            .with("rise_time_s", reached.rise_time_s),
        Err(why) => object.told("verdict", Err::<&str, _>(not_judged_words(why))),
    }
}
