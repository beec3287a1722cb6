//! The JSON object of `alternatives`.

use super::findings::findings;
use super::{AlternativeColumn, Alternatives, ColumnPart, JudgedAlternative};
use crate::answer::{self, Json, Object};
use crate::audit::verdict_key;
use crate::design;
use crate::linearize::passivity_body;
use crate::project::Loaded;
use crate::trial;

/// The JSON object of `alternatives`.
pub(crate) fn json(loaded: &Loaded, found: &Alternatives) -> String {
    let body = Object::new()
        .each("alternatives", &found.judged, row)
        .with("not_reached", found.not_reached.as_slice())
        .with("findings", findings(found));
    answer::json("alternatives", loaded, body)
}

fn row(one: &JudgedAlternative) -> Object {
    let failed = one.design.as_ref().err().map_or("", String::as_str);
    let view = one.design.as_ref().ok();
    let verdict = view.map(|view| verdict_key(view.designed.view.audit.verdict));
    // the laws of a design that was audited are transfer functions
    let design = view.and_then(|view| design::body(view).ok());
    let machine = view.and_then(|view| view.trial.as_ref()).map(trial::body);
    let no_machine = if view.is_some() { "the project describes a plant and no machine" } else { failed };
    Object::new()
        .with("name", one.name.as_str())
        .with("settings", one.loaded.settings.as_slice())
        .known("verdict", verdict, failed)
        .known("design", design, failed)
        .known("machine", machine, no_machine)
        .with("columns", columns(one))
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
    let reason = feasible.as_ref().err().map_or("", String::as_str).to_string();
    let own = Object::new().known("feasible", feasible.ok(), &reason);
    let own = told(own, of(&all, &ColumnPart::Loop).chain(of(&all, &ColumnPart::Rig)));
    own.with(
        "specifications",
        named(|part| match part {
            ColumnPart::Specification(_, name) => Some(name),
            _ => None,
        }),
    )
    .with(
        "scenarios",
        named(|part| match part {
            ColumnPart::Scenario(name) => Some(name),
            _ => None,
        }),
    )
    .with("passivity", passivity(one))
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
        let reason = column.value.as_ref().err().map_or("", String::as_str);
        object.known(
            column.key,
            column.value.as_ref().ok().map(|value| number(*value, column.digits)),
            reason,
        )
    })
}

/// Of the impedance at the load, as `linearize` says it.
fn passivity(one: &JudgedAlternative) -> Object {
    let linearization = one.linearization.as_ref();
    let failed = linearization.err().map_or("", String::as_str);
    let open = linearization.ok().map(|found| passivity_body(&found.open_loop.passivity));
    let closed = linearization.ok().and_then(|found| found.closed_loop.as_ref());
    let absent = linearization.ok().and_then(|found| found.closed_loop_absent.as_deref());
    Object::new().known("open_loop", open, failed).known(
        "closed_loop",
        closed.map(|view| passivity_body(&view.passivity)),
        absent.unwrap_or(failed),
    )
}
