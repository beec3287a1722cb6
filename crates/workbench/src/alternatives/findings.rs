//! What follows from the columns, in sentences.

use super::{Alternatives, ComparedMeasures, JudgedAlternative, MEASURES, MovedRange};
use crate::design::status_sentence;
use crate::project::AS_DECLARED;
use crate::quantity::{DisplayUnit, significant};
use crate::trial::Agreement;

/// Feasibility of each, dominance, costs against the project as declared, and what was not reached.
pub(crate) fn findings(found: &Alternatives) -> Vec<String> {
    let mut sentences: Vec<String> = found.judged.iter().map(status).collect();
    sentences.extend(shared(found.judged.iter().flat_map(lacking)));
    let comparable = |one: &&JudgedAlternative| one.is_comparable();
    let measured = |one: &JudgedAlternative| Some((one.name.clone(), ComparedMeasures::of(&one.columns())?));
    sentences
        .extend(dominance(&found.judged.iter().filter(comparable).filter_map(measured).collect::<Vec<_>>()));
    let all: Vec<_> = found.judged.iter().filter_map(measured).collect();
    sentences.extend(costs(&all));
    let not_reached = found.not_reached.iter().map(|name| format!("{name}: not reached"));
    sentences.extend(not_reached);
    sentences
}

fn status(one: &JudgedAlternative) -> String {
    match &one.design {
        Ok(view) => format!("{}: {}", one.name, status_sentence(view)),
        Err(reason) => format!("{}: not judged: {reason}", one.name),
    }
}

/// Each sentence once, behind the names of all that it holds for.
fn shared<'a>(told: impl Iterator<Item = (&'a str, String)>) -> Vec<String> {
    let mut sentences: Vec<(Vec<&str>, String)> = Vec::new();
    for (name, sentence) in told {
        match sentences.iter_mut().find(|(_, known)| *known == sentence) {
            Some((names, _)) => names.push(name),
            None => sentences.push((vec![name], sentence)),
        }
    }
    sentences.into_iter().map(|(names, sentence)| format!("{}: {sentence}", names.join(", "))).collect()
}

/// What the machine contradicts, what the verdict leaves out, and why nothing was driven.
fn lacking(one: &JudgedAlternative) -> Vec<(&str, String)> {
    let view = one.design.as_ref().ok();
    let runs =
        view.and_then(|view| view.trial.as_ref()).map(|trial| trial.runs.as_slice()).unwrap_or_default();
    let contradicts = runs.iter().filter(|run| run.agreement == Agreement::Contradicts);
    let contradicts =
        contradicts.map(|run| format!("the machine contradicts the verdict: {}: {}", run.what, run.reason));
    let caveats = view.map(|view| view.designed.view.caveats.as_slice()).unwrap_or_default();
    let caveats = caveats.iter().map(|caveat| caveat.sentence.clone());
    let not_driven = one.runs.as_ref().err().filter(|_| view.is_some()).cloned();
    let moved = one.moved.iter().map(moved_words);
    contradicts
        .chain(caveats)
        .chain(not_driven)
        .chain(moved)
        .map(|sentence| (one.name.as_str(), sentence))
        .collect()
}

fn moved_words(range: &MovedRange) -> String {
    let number = |value: f64| significant(value, 4);
    let [[_, least, greatest], [_, less, more]] = [range.stated, range.moved];
    format!(
        "the range of {} follows the rig: {} to {} in place of {} to {}",
        range.name,
        number(less),
        number(more),
        number(least),
        number(greatest)
    )
}

/// Among those that satisfy every specification, on the machine too.
fn dominance(feasible: &[(String, ComparedMeasures)]) -> Vec<String> {
    if feasible.len() < 2 {
        return vec![];
    }
    let mut sentences = Vec::new();
    for (name, measures) in feasible {
        let dominated = feasible.iter().filter(|(_, other)| measures.dominates(other));
        let dominated: Vec<&str> = dominated.map(|(other, _)| other.as_str()).collect();
        if !dominated.is_empty() {
            let others = dominated.join(", ");
            sentences.push(format!(
                "{name} dominates {others}: no worse in disturbance, control effort, order and delay tolerated, and better in one of them"
            ));
        }
    }
    if sentences.is_empty() {
        sentences.push(
            "of those that satisfy every specification and that the machine does not contradict none dominates another in disturbance, control effort, order and delay tolerated"
                .to_string(),
        );
    }
    sentences
}

/// Each against the project as it is declared.
fn costs(all: &[(String, ComparedMeasures)]) -> Vec<String> {
    let Some(((base, measures), others)) = all.split_first() else { return vec![] };
    if base != AS_DECLARED {
        return vec![];
    }
    let sentence = |(name, other): &(String, ComparedMeasures)| {
        let parts = MEASURES.iter().enumerate().map(|(index, (key, words))| {
            let [own, given] = [other.0[index], measures.0[index]].map(|value| words_of(key, value));
            if own == given {
                format!("{words} the same ({own})")
            } else {
                format!("{words} {own} for {given}")
            }
        });
        format!("{name} against {base}: {}", parts.collect::<Vec<_>>().join(", "))
    };
    others.iter().map(sentence).collect()
}

fn words_of(key: &str, value: f64) -> String {
    match key {
        "disturbance_peak_n" => DisplayUnit::NEWTON.text(value, 3),
        "control_rms_v" => DisplayUnit::VOLT.text(value, 3),
        "delay_margin_s" => DisplayUnit::MILLISECOND.text(value, 3),
        _ => significant(value, 1),
    }
}
