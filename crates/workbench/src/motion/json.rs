//! JSON: keys get the names of the motion, texts its words.

use super::Vocabulary;
use crate::answer::{Json, Object};
use crate::quantity::MotionKind;

/// The same object for a rig that turns. What hashes, versions and settings say stays.
pub(super) fn said(object: Object, words: &Vocabulary) -> Object {
    object.entries().fold(Object::new(), |all, (key, value)| {
        let value = value_said(&key, value, words);
        all.with(MotionKind::Rotary.name(&key), value)
    })
}

fn value_said(key: &str, value: Json, words: &Vocabulary) -> Json {
    match value {
        Json::Text(text) if is_quantity(key) => MotionKind::Rotary.name(&text).into_owned().into(),
        Json::Text(text) if key == "symbol" => MotionKind::Rotary.formula(&text).into_owned().into(),
        Json::Text(text) if !is_kept(key) => words.of(&text).into(),
        Json::List(items) => Json::List(items.into_iter().map(|item| value_said(key, item, words)).collect()),
        Json::Object(object) => said(object, words).into(),
        other => other,
    }
}

/// Keys whose text is the name of a quantity.
fn is_quantity(key: &str) -> bool {
    ["metric", "signal", "column", "quantity"].contains(&key)
}

/// Keys whose text is not a sentence.
fn is_kept(key: &str) -> bool {
    [
        "version",
        "command",
        "title",
        "project_sha256",
        "settings",
        "catalogue_files",
        "verdict",
        "status",
        "kind",
        "hose",
        "file",
        "cause",
    ]
    .contains(&key)
}
