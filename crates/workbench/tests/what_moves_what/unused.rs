//! A key that moves no part of the model must be used nevertheless: a command answers differently.

use std::cell::OnceCell;
use std::collections::BTreeSet;
use std::sync::Mutex;

use phea_workbench::command::{Request, answer};
use phea_workbench::engineering::alternatives::retracted_length;
use phea_workbench::engineering::setup::Setup;
use phea_workbench::project::{KeyEntry, Loaded};
use phea_workbench::source::Memory;

use super::rigs::{absent_tables, is_within, others, stated};
use super::{loaded, on_every_rig};

/// The keys on which no answer depends, as stated in the guide.
const UNUSED: [&str; 2] = ["series.line.minimum_bend_radius", "valve.response_time"];

/// Checks that on some rig another value of each of these keys is rejected or answered differently,
/// unless the key is in [`UNUSED`].
pub(super) fn unmoved_keys_are_used(still: &BTreeSet<&str>, keys: &[KeyEntry]) {
    let open = Mutex::new(still.clone());
    on_every_rig(|text, settings| {
        let own = loaded(text, settings).unwrap();
        let before = OnceCell::new();
        let absent = absent_tables(keys, &own.project);
        for entry in keys.iter().filter(|entry| !is_within(entry, &absent)) {
            if !open.lock().unwrap().contains(entry.path.as_str()) {
                continue;
            }
            let with = |value: &String| {
                let changed = [settings, &[format!("{}={value}", entry.path)]].concat();
                loaded(text, &changed)
            };
            let is_used = |other: &Loaded| {
                let before = || before.get_or_init(|| outputs(&own));
                other.project != own.project && *before() != outputs(other)
            };
            let near: Vec<Option<Loaded>> = others(entry, &own.project).0.iter().map(with).collect();
            let Some(accepted) = near.iter().flatten().next() else { continue };
            let differs = |other: Option<&Loaded>| other.is_none_or(is_used);
            let far = || far(entry, accepted).into_iter();
            if near.iter().map(Option::as_ref).any(differs)
                || far().any(|value| differs(with(&value).as_ref()))
            {
                open.lock().unwrap().remove(entry.path.as_str());
            }
        }
    });
    assert_eq!(open.into_inner().unwrap(), UNUSED.into(), "keys that no answer depends on");
}

/// Values within the range of a number, far from the declared one.
fn far(entry: &KeyEntry, own: &Loaded) -> Vec<String> {
    let Some(value) = stated(entry, &own.project) else { return vec![] };
    let values = [0.01, 0.3, 3.0, 100.0].map(|factor| factor * value).into_iter();
    values.filter(|value| entry.key.range.contains(*value)).map(|value| format!("{value:?}")).collect()
}

/// Output of the quick commands on a project, the warnings when it is read, and its length, which
/// `alternatives` compares.
fn outputs(loaded: &Loaded) -> String {
    let source = Memory::default();
    let text = |request: &Request| match answer(&source, loaded, &[], request) {
        Ok(answer) => answer.text(),
        Err(error) => error.to_string(),
    };
    let printed = [Request::Check, Request::Size { gain: None, length: None }].map(|request| text(&request));
    let warned: Vec<&str> = loaded.warnings.iter().map(|warning| warning.message.as_str()).collect();
    let rig = Setup::rig_of(&loaded.project).ok();
    let length = loaded.project.actuator.as_ref().zip(rig).map(|(own, rig)| retracted_length(own, &rig));
    format!("{warned:?} {printed:?} {length:?}")
}
