//! Sentences about one alternative.

use phea_engineering::alternatives::{JudgedAlternative, MovedRange};
use phea_engineering::rig::OutsideParameter;
use phea_engineering::simulate::{ScenarioRun, required_of_run};
use phea_engineering::trial::Agreement;
use phea_qft::design::DesignStatus;
use serde::{Deserialize, Serialize};

use super::super::words::judge_error_words;
use crate::caveat::{self, outside_parameters};
use crate::design::verdict_sentence;
use crate::project::{ImpedanceForm, LINEAR_PARAMETERS};
use crate::quantity::{DisplayUnit, MotionKind, MotionWords, fitting};
use crate::simulate::requirement_sentence;
use crate::trial::{finding_words, run_name};

/// Sentences about an alternative.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct AlternativeSentences {
    /// Warning on a family that does not contain the rig.
    pub(crate) outside: Option<String>,
    /// Outcome of a design that neither satisfies the specifications nor finds them infeasible.
    pub(crate) otherwise: Option<String>,
    /// Requirements in time that are not satisfied.
    pub(crate) missed: Vec<String>,
    /// Effects that the verdict does not include, without the name of the alternative.
    pub(crate) lacking: Vec<String>,
    /// Ranges that follow the rig.
    pub(crate) moved: Vec<String>,
}

impl AlternativeSentences {
    pub(super) fn of(one: &JudgedAlternative) -> AlternativeSentences {
        let motion = one.loaded.project.motion();
        let outside = one.outside.as_ref();
        AlternativeSentences {
            outside: outside.map(|outside| outside_words(&one.name, outside, !one.moved.is_empty())),
            otherwise: otherwise(one),
            missed: missing(one),
            lacking: lacking(one),
            moved: one.moved.iter().map(|range| moved_words(&one.name, range, motion)).collect(),
        }
    }
}

/// A sentence on ranges that do not contain the rig of an alternative, whether or not they were
/// moved.
pub(crate) fn outside_words(name: &str, outside: &[OutsideParameter], moved: bool) -> String {
    let remedy = match moved {
        false => "state them in `set`, or let them follow by `recentre = true`",
        true => {
            "`recentre` moved them by what the rigs differ, and the declared rig lies outside of its own: state them in `set`"
        }
    };
    format!(
        "{name}: the ranges of [uncertainty] do not contain its rig ({}): {remedy}",
        outside_parameters(outside)
    )
}

/// Outcome of a design that neither satisfies the specifications nor finds them infeasible.
fn otherwise(one: &JudgedAlternative) -> Option<String> {
    match &one.design {
        Err(reason) => Some(format!("{}: not judged: {}", one.name, judge_error_words(reason))),
        Ok(view) if matches!(view.design.status, DesignStatus::Infeasible(_)) => None,
        Ok(_) if one.feasible() == Some(true) => None,
        Ok(view) => {
            Some(format!("{}: {}", one.name, verdict_sentence(&view.verdict(), one.loaded.project.motion())))
        }
    }
}

/// Requirements in time that an alternative misses in its scenarios.
fn missing(one: &JudgedAlternative) -> Vec<String> {
    let Ok(runs) = &one.runs else { return vec![] };
    let missed = |run: &ScenarioRun| -> Vec<String> {
        let found = required_of_run(&one.loaded.project, run).into_iter();
        let missed = found.filter(|held| held.is_satisfied() == Some(false));
        missed.map(|held| format!("{} in `{}` {}", one.name, run.name, requirement_sentence(&held))).collect()
    };
    runs.iter().flat_map(missed).collect()
}

/// Contradictions by the machine, effects that the verdict leaves out, and the reason why nothing
/// was driven.
fn lacking(one: &JudgedAlternative) -> Vec<String> {
    let view = one.design.as_ref().ok();
    let runs =
        view.and_then(|view| view.trial.as_ref()).map(|trial| trial.runs.as_slice()).unwrap_or_default();
    let contradicts: Vec<_> = runs.iter().filter(|run| run.agreement == Agreement::Contradicts).collect();
    let contradicts = contradicts.split_first().map(|(first, further)| {
        // the remedy is in the reason after the first sentence, and with `design`
        let reason = finding_words(&first.reason.finding, first.units);
        let further = match further.len() {
            0 => String::new(),
            1 => ", and in another run".to_string(),
            count => format!(", and in {count} further runs"),
        };
        format!("the nonlinear simulation contradicts the verdict: {}: {reason}{further}", run_name(first))
    });
    let caveats = view.map(|view| &view.designed.view);
    let caveats = caveats.into_iter().flat_map(|view| caveat::sentences(&view.caveats, &view.units));
    let impedance = impedance(one).into_iter().flatten();
    let not_driven = one.runs.as_ref().err().filter(|_| view.is_some()).map(|reason| reason.to_string());
    contradicts.into_iter().chain(caveats).chain(impedance).chain(not_driven).collect()
}

/// Properties that are compared for a loop with a virtual impedance at the load.
fn impedance(one: &JudgedAlternative) -> Option<Vec<String>> {
    let declared = one.loaded.project.controller.as_ref()?.impedance?;
    let MotionWords { force, position, .. } = one.loaded.project.motion().words();
    let form = (declared.form == ImpedanceForm::Admittance).then(|| {
        format!(
            "designed as the same loop with form = \"impedance\": of the {position} it is C_x = G (M_v s^2 + B_v s + K_v)"
        )
    });
    let disturbance_words = format!(
        "the disturbance is the whole change of the {force}, and counts what the virtual impedance asks for: the impedances at the \
         load show how near it comes"
    );
    Some(form.into_iter().chain([disturbance_words]).collect())
}

/// A range that follows the rig.
fn moved_words(name: &str, range: &MovedRange, motion: MotionKind) -> String {
    let [[_, least, greatest], [_, less, more]] = [range.stated, range.moved];
    let known = LINEAR_PARAMETERS.iter().find(|parameter| parameter.key.name == range.name);
    let unit = known.map_or(DisplayUnit::ONE, |known| match known.key.dimension.si {
        "N/m" => motion.unit(DisplayUnit::MEGANEWTON_PER_METRE),
        _ => fitting(more.abs(), motion.dimension(known.key.dimension)),
    });
    let number = |value: f64| unit.number(value, 3);
    let moved = unit.with_symbol(format!("{} to {}", number(less), number(more)));
    let stated = unit.with_symbol(format!("{} to {}", number(least), number(greatest)));
    format!("{name}, {} {moved} in place of {stated}", range.name)
}
