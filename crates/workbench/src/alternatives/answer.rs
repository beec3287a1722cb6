//! The JSON object of `alternatives`.

use super::document::told_first;
use super::findings::{findings, of_case};
use super::front;
use super::words::{judge_error_words, no_number_words, undecided_words};
use super::{AlternativeColumn, Alternatives, ColumnPart, JudgedAlternative, JudgedCase, MovedRange};
use crate::answer::{Body, Describe, Json, Object};
use crate::design;
use crate::linearize::{no_closed_impedance_words, passivity_body};
use crate::specification::subject_words;
use crate::trial;
use crate::verdict_words::verdict_key;

/// What `alternatives` says to programs.
pub(crate) fn body(found: &Alternatives) -> Object {
    Object::new()
        .each("alternatives", &found.judged, row)
        .with("not_reached", found.not_reached.as_slice())
        .with("warnings", told_first(found))
        .with("findings", findings(found))
        .each("load_cases", &found.cases, case)
        .maybe("front", found.front.as_ref().map(front::json))
}

/// The same under a load case.
fn case(one: &JudgedCase) -> Object {
    Object::new()
        .with("name", one.name.as_str())
        .with("settings", one.settings.as_slice())
        .each("alternatives", &one.judged, row)
        .with("not_reached", one.not_reached.as_slice())
        .with("findings", of_case(one))
}

fn row(one: &JudgedAlternative) -> Object {
    let failed = one.design.as_ref().err().map_or(String::new(), judge_error_words);
    let view = one.design.as_ref().ok();
    let verdict = view.map(|view| verdict_key(view.designed.view.verdict()));
    // the laws of a design that was audited are transfer functions
    let design = view.and_then(|view| design::body(view).ok());
    let machine = view.and_then(|view| view.trial.as_ref()).map(|trial| trial::body(trial).into_json());
    let no_machine = if view.is_some() { "the project describes a plant and no machine" } else { &failed };
    Object::new()
        .with("name", one.name.as_str())
        .with("settings", one.loaded.settings.as_slice())
        .each("moved_ranges", &one.moved, moved)
        .known("verdict", verdict, &failed)
        .known("design", design, &failed)
        .known("machine", machine, no_machine)
        .with("columns", columns(one))
}

fn moved(range: &MovedRange) -> Object {
    let numbers = |[nominal, minimum, maximum]: [f64; 3]| {
        Object::new().with("nominal", nominal).with("minimum", minimum).with("maximum", maximum)
    };
    Object::new()
        .with("name", range.name.as_str())
        .with("stated", numbers(range.stated))
        .with("moved", numbers(range.moved))
}

fn columns(one: &JudgedAlternative) -> Object {
    let all = one.columns().0;
    let mut parts: Vec<&ColumnPart> = Vec::new();
    for (part, _) in &all {
        if !parts.contains(&part) {
            parts.push(part);
        }
    }
    let named = |wanted: fn(&ColumnPart) -> Option<&str>| {
        let named = parts.iter().filter_map(move |part| Some((wanted(part)?, *part)));
        let objects = named.map(|(name, part)| told(Object::new().with("name", name), of(&all, part)));
        objects.collect::<Vec<_>>()
    };
    let feasible = one.feasible();
    let reason = if feasible.is_some() { String::new() } else { undecided_words(one) };
    let stability = one.design.as_ref().map(|view| verdict_key(view.designed.view.audit.stability.verdict));
    let failed = one.design.as_ref().err().map_or(String::new(), judge_error_words);
    let own = Object::new().known("feasible", feasible, &reason).known(
        "stable_with_its_load",
        stability.ok(),
        &failed,
    );
    let own = told(own, of(&all, &ColumnPart::Loop).chain(of(&all, &ColumnPart::Rig)));
    let currency = one.counted.currency.map(|currency| currency.code());
    let own = own.maybe("parts_currency", currency);
    own.with(
        "specifications",
        named(|part| match part {
            ColumnPart::Specification(_, name) => Some(subject_words(*name)),
            _ => None,
        }),
    )
    .with(
        "scenarios",
        named(|part| match part {
            ColumnPart::Scenario(name) => Some(name.as_str()),
            _ => None,
        }),
    )
    .with("impedance", impedances(&all))
    .with("passivity", passivity(one))
}

/// |Z| at each frequency.
fn impedances(all: &[(ColumnPart, AlternativeColumn)]) -> Vec<Object> {
    let mut frequencies: Vec<f64> = Vec::new();
    for (part, _) in all {
        match part {
            ColumnPart::Impedance(frequency) if !frequencies.contains(frequency) => {
                frequencies.push(*frequency);
            }
            _ => {}
        }
    }
    let at = |frequency: &f64| {
        let part = ColumnPart::Impedance(*frequency);
        told(Object::new().with("frequency_rad_per_s", *frequency), of(all, &part))
    };
    frequencies.iter().map(at).collect()
}

/// A whole number is printed as one.
fn number(value: f64, digits: usize) -> Json {
    if digits == 0 { Json::Integer(value as i64) } else { Json::Number(value) }
}

/// The columns of a part.
fn of<'c>(
    all: &'c [(ColumnPart, AlternativeColumn)],
    part: &'c ColumnPart,
) -> impl Iterator<Item = &'c AlternativeColumn> {
    all.iter().filter(move |(own, _)| own == part).map(|(_, column)| column)
}

fn told<'c>(object: Object, columns: impl Iterator<Item = &'c AlternativeColumn>) -> Object {
    columns.fold(object, |object, column| {
        let reason = column.value.as_ref().err().map_or(String::new(), no_number_words);
        object.known(
            column.key.quantity(),
            column.value.as_ref().ok().map(|value| number(*value, column.digits)),
            &reason,
        )
    })
}

/// Of the impedance at the load, as `linearize` says it.
fn passivity(one: &JudgedAlternative) -> Object {
    let linearization = one.linearization.as_ref();
    let failed = linearization.err().map_or(String::new(), |reason| reason.to_string());
    let open = linearization.ok().map(|found| passivity_body(&found.open_loop.passivity).into_object());
    let closed = linearization.ok().and_then(|found| found.closed_loop.as_ref());
    let closed = closed.filter(|_| one.deployed.is_ok());
    let absent = linearization.ok().and_then(|found| found.closed_loop_absent).map(no_closed_impedance_words);
    let absent = one.deployed.as_ref().err().map(|reason| reason.to_string()).or(absent.map(str::to_string));
    Object::new().known("open_loop", open, &failed).known(
        "closed_loop",
        closed.map(|view| passivity_body(&view.passivity).into_object()),
        absent.as_deref().unwrap_or(&failed),
    )
}
