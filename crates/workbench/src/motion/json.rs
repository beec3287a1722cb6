//! JSON: keys, and texts that name a quantity, get the names of the motion.

use crate::answer::{Json, Object};
use crate::quantity::MotionKind;

/// The same object for a rig that turns.
pub(super) fn said(object: Object) -> Object {
    object.entries().fold(Object::new(), |all, (key, value)| {
        let value = value_said(&key, value);
        all.with(MotionKind::Rotary.name(&key), value)
    })
}

fn value_said(key: &str, value: Json) -> Json {
    match value {
        Json::Text(text) if is_quantity(key) => MotionKind::Rotary.name(&text).into_owned().into(),
        Json::List(items) => Json::List(items.into_iter().map(|item| value_said(key, item)).collect()),
        Json::Object(object) => said(object).into(),
        other => other,
    }
}

/// Keys whose text is the name of a quantity.
fn is_quantity(key: &str) -> bool {
    ["metric", "signal", "column", "quantity"].contains(&key)
}
