//! The answer of `alternatives`.

mod columns;
mod front;

use phea_engineering::alternatives::{JudgedAlternative, MovedRange};
use phea_qft::verification::Verdict;

use super::document::first_warnings;
use super::findings::{findings, of_case};
use super::printed::{PrintedAlternative, PrintedAlternatives, PrintedCase};
use super::words::judge_error_words;
use crate::answer::{Answer, OrReason, PutTogether};
use crate::design::{self, DesignAnswer};
use crate::quantity::MotionKind;
use crate::trial::{self, TrialAnswer};
use columns::{AlternativeColumnsAnswer, columns};
use front::{FrontAnswer, front};

/// Answer of `alternatives`.
#[derive(Answer)]
pub(crate) struct AlternativesAnswer {
    /// Project as it is declared, then its alternatives in the order of the file.
    alternatives: Vec<PutTogether<AlternativeAnswer>>,
    /// Names of the alternatives that were not finished when the command was stopped.
    not_reached: Vec<String>,
    /// Declared effects that the verdicts do not include.
    warnings: Vec<String>,
    /// Comparison of the alternatives in sentences.
    findings: Vec<String>,
    /// Same alternatives in each load case.
    load_cases: Vec<LoadCaseAnswer>,
    /// Alternatives over a swept key, if a front was requested.
    #[answer(optional)]
    front: Option<FrontAnswer>,
}

/// Alternatives in a load case.
#[derive(Answer)]
struct LoadCaseAnswer {
    /// Name of the load case.
    name: String,
    /// Settings of the load case, each `path=value`.
    settings: Vec<String>,
    /// Project as it is declared, then its alternatives in the order of the file.
    alternatives: Vec<PutTogether<AlternativeAnswer>>,
    /// Names of the alternatives that were not finished when the command was stopped.
    not_reached: Vec<String>,
    /// Comparison of the alternatives in sentences.
    findings: Vec<String>,
}

/// Alternative with its own design.
#[derive(Answer)]
pub(super) struct AlternativeAnswer {
    /// Name of the alternative.
    name: String,
    /// Settings of the alternative, each `path=value`.
    settings: Vec<String>,
    /// Ranges of `[uncertainty]` that follow the rig of the alternative.
    moved_ranges: Vec<MovedRangeAnswer>,
    /// Verdict on the designed controller over the family.
    verdict: OrReason<Verdict>,
    /// Design, as `design` returns it.
    design: OrReason<DesignAnswer>,
    /// Designed controller on the nonlinear machine.
    machine: OrReason<TrialAnswer>,
    /// Numbers by which alternatives are compared.
    columns: AlternativeColumnsAnswer,
}

/// Range of an uncertain parameter, moved in proportion to its derived value.
#[derive(Answer)]
struct MovedRangeAnswer {
    /// Name of the parameter.
    name: String,
    /// Range as the project states it.
    stated: ParameterRangeAnswer,
    /// Range of the alternative.
    moved: ParameterRangeAnswer,
}

/// Range of a parameter in SI.
#[derive(Answer)]
struct ParameterRangeAnswer {
    /// Nominal value.
    nominal: f64,
    /// Least value.
    minimum: f64,
    /// Greatest value.
    maximum: f64,
}

/// Answer of `alternatives`.
pub(crate) fn body(found: &PrintedAlternatives) -> AlternativesAnswer {
    AlternativesAnswer {
        alternatives: found.judged.iter().map(put_together).collect(),
        not_reached: found.not_reached.clone(),
        warnings: first_warnings(found),
        findings: findings(found),
        load_cases: found.cases.iter().map(|case| load_case(case, found.motion)).collect(),
        front: found.front.as_ref().map(front),
    }
}

fn load_case(one: &PrintedCase, motion: MotionKind) -> LoadCaseAnswer {
    LoadCaseAnswer {
        name: one.name.clone(),
        settings: one.settings.clone(),
        alternatives: one.judged.iter().map(put_together).collect(),
        not_reached: one.not_reached.clone(),
        findings: of_case(one, motion),
    }
}

fn put_together(one: &PrintedAlternative) -> PutTogether<AlternativeAnswer> {
    PutTogether::new(one.body.clone())
}

/// Answer on one alternative.
pub(super) fn alternative(one: &JudgedAlternative) -> AlternativeAnswer {
    let failed = one.design.as_ref().err().map_or(String::new(), judge_error_words);
    let view = one.design.as_ref().ok();
    let trial = view.and_then(|view| view.trial.as_ref());
    let no_machine = if view.is_some() { "the project describes a plant and no machine" } else { &failed };
    AlternativeAnswer {
        name: one.name.clone(),
        settings: one.loaded.settings.clone(),
        moved_ranges: one.moved.iter().map(moved).collect(),
        verdict: OrReason::new(view.map(|view| view.designed.view.verdict()), &failed),
        // the laws of a design that was audited are transfer functions
        design: OrReason::new(view.and_then(|view| design::body(view).ok()), &failed),
        machine: OrReason::new(trial.map(trial::body), no_machine),
        columns: columns(one),
    }
}

fn moved(range: &MovedRange) -> MovedRangeAnswer {
    let numbers = |[nominal, minimum, maximum]: [f64; 3]| ParameterRangeAnswer { nominal, minimum, maximum };
    MovedRangeAnswer { name: range.name.clone(), stated: numbers(range.stated), moved: numbers(range.moved) }
}
