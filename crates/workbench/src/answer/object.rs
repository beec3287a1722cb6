//! JSON as a value: what a command says to programs, key by key, and why a number is missing.

use std::borrow::Cow;

use num_complex::Complex64;
use serde::ser::{SerializeMap, Serializer};
use serde::{Deserialize, Serialize};

use phea_engineering::plant_names::{NamedPlant, NamedValue};

use crate::plant_names::ADDED;
use crate::quantity::{MotionKind, QuantityName};

/// A value of JSON. Infinity, which JSON lacks, is printed as the text `inf`, NaN as `null`.
/// Between computers it has no name of a quantity, only its text.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) enum Json {
    Null,
    Flag(bool),
    Count(u64),
    Integer(i64),
    Number(f64),
    Text(String),
    List(Vec<Json>),
    Object(Object),
    /// Name of a quantity in a rig of the motion in which it is printed.
    // last, since serde counts the variants after a skipped one differently in both directions
    #[serde(skip)]
    Name(QuantityName),
}

impl Json {
    /// With texts in place of the names of quantities, for a rig of this motion.
    fn for_motion(self, motion: MotionKind) -> Json {
        match self {
            Json::Name(name) => Json::Text(name.text(motion).into_owned()),
            Json::List(items) => Json::List(items.into_iter().map(|item| item.for_motion(motion)).collect()),
            Json::Object(object) => Json::Object(object.for_motion(motion)),
            other => other,
        }
    }
}

/// A key of an object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) enum ObjectKey {
    /// Key of every rig.
    Text(String),
    /// Name of a quantity in a rig of the motion in which it is printed.
    #[serde(skip)]
    Name(QuantityName),
    /// Reason for which that quantity has no value.
    #[serde(skip)]
    Reason(QuantityName),
}

impl ObjectKey {
    /// Key of the reason for which this one has no value.
    pub(crate) fn reason(&self) -> ObjectKey {
        match self {
            ObjectKey::Text(text) => ObjectKey::Text(reason_key(text)),
            ObjectKey::Name(name) | ObjectKey::Reason(name) => ObjectKey::Reason(*name),
        }
    }

    /// Its text for a rig of this motion.
    pub(crate) fn text(&self, motion: MotionKind) -> Cow<'_, str> {
        match self {
            ObjectKey::Text(text) => text.into(),
            ObjectKey::Name(name) => name.text(motion),
            ObjectKey::Reason(name) => reason_key(&name.text(motion)).into(),
        }
    }
}

fn reason_key(key: &str) -> String {
    format!("{key}_reason")
}

/// An object of JSON, whose keys are in the order in which they were added.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Object(Vec<(ObjectKey, Json)>);

impl Object {
    /// Without a key.
    pub(crate) fn new() -> Object {
        Object::default()
    }

    /// Adds a key.
    pub(crate) fn push(&mut self, key: impl Into<ObjectKey>, value: impl Into<Json>) {
        self.0.push((key.into(), value.into()));
    }

    /// With one more key.
    pub(crate) fn with(mut self, key: impl Into<ObjectKey>, value: impl Into<Json>) -> Object {
        self.0.push((key.into(), value.into()));
        self
    }

    /// With a key that is left out where it has no value.
    pub(crate) fn maybe(self, key: impl Into<ObjectKey>, value: Option<impl Into<Json>>) -> Object {
        match value {
            Some(value) => self.with(key, value),
            None => self,
        }
    }

    /// With all keys of another object behind its own.
    pub(crate) fn and(mut self, other: Object) -> Object {
        self.0.extend(other.0);
        self
    }

    /// With texts in place of the names of quantities, for a rig of this motion.
    pub(crate) fn for_motion(self, motion: MotionKind) -> Object {
        let each = self.0.into_iter();
        let each = each.map(|(key, json)| (key.text(motion).into_owned().into(), json.for_motion(motion)));
        Object(each.collect())
    }

    /// Printed by itself, for rigs of this motion.
    pub fn print(&self, motion: MotionKind) -> String {
        // every key is a text and every printed number is finite, so that nothing can fail
        serde_json::to_string_pretty(&PrintedObject { object: self, motion }).unwrap_or_default()
    }
}

/// An object as it is printed for rigs of a motion.
struct PrintedObject<'o> {
    object: &'o Object,
    motion: MotionKind,
}

impl Serialize for PrintedObject<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let PrintedObject { object, motion } = *self;
        let mut map = serializer.serialize_map(Some(object.0.len()))?;
        for (key, json) in &object.0 {
            map.serialize_entry(&key.text(motion), &PrintedJson { json, motion })?;
        }
        map.end()
    }
}

/// A value as it is printed for rigs of a motion.
struct PrintedJson<'j> {
    json: &'j Json,
    motion: MotionKind,
}

impl Serialize for PrintedJson<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let motion = self.motion;
        match self.json {
            Json::Null => serializer.serialize_none(),
            Json::Flag(value) => serializer.serialize_bool(*value),
            Json::Count(value) => serializer.serialize_u64(*value),
            Json::Integer(value) => serializer.serialize_i64(*value),
            Json::Number(value) => serialize_number(*value, serializer),
            Json::Text(text) => serializer.serialize_str(text),
            Json::Name(name) => serializer.serialize_str(&name.text(motion)),
            Json::List(items) => {
                serializer.collect_seq(items.iter().map(|json| PrintedJson { json, motion }))
            }
            Json::Object(object) => PrintedObject { object, motion }.serialize(serializer),
        }
    }
}

fn serialize_number<S: Serializer>(value: f64, serializer: S) -> Result<S::Ok, S::Error> {
    match value {
        value if value.is_finite() => serializer.serialize_f64(value),
        f64::INFINITY => serializer.serialize_str("inf"),
        f64::NEG_INFINITY => serializer.serialize_str("-inf"),
        _ => serializer.serialize_none(),
    }
}

impl From<&str> for ObjectKey {
    fn from(text: &str) -> ObjectKey {
        ObjectKey::Text(text.to_string())
    }
}

impl From<String> for ObjectKey {
    fn from(text: String) -> ObjectKey {
        ObjectKey::Text(text)
    }
}

impl From<QuantityName> for ObjectKey {
    fn from(name: QuantityName) -> ObjectKey {
        ObjectKey::Name(name)
    }
}

macro_rules! from {
    ($($kind:ty => $of:expr),* $(,)?) => {
        $(impl From<$kind> for Json {
            fn from(value: $kind) -> Json {
                ($of)(value)
            }
        })*
    };
}

from! {
    bool => Json::Flag,
    u8 => |value| Json::Count(u64::from(value)),
    u32 => |value| Json::Count(u64::from(value)),
    u64 => Json::Count,
    usize => |value| Json::Count(value as u64),
    i32 => |value| Json::Integer(i64::from(value)),
    i64 => Json::Integer,
    f64 => Json::Number,
    char => |value: char| Json::Text(value.to_string()),
    &str => |text: &str| Json::Text(text.to_string()),
    String => Json::Text,
    QuantityName => Json::Name,
    Complex64 => |value: Complex64| Json::from([value.re, value.im]),
    Object => Json::Object,
}

impl<Value: Into<Json>> From<Option<Value>> for Json {
    fn from(value: Option<Value>) -> Json {
        value.map_or(Json::Null, Into::into)
    }
}

impl<Value: Into<Json>> From<Vec<Value>> for Json {
    fn from(values: Vec<Value>) -> Json {
        Json::List(values.into_iter().map(Into::into).collect())
    }
}

impl<Value: Into<Json>, const COUNT: usize> From<[Value; COUNT]> for Json {
    fn from(values: [Value; COUNT]) -> Json {
        Json::List(values.into_iter().map(Into::into).collect())
    }
}

impl<Value: Into<Json> + Clone> From<&[Value]> for Json {
    fn from(values: &[Value]) -> Json {
        Json::List(values.iter().cloned().map(Into::into).collect())
    }
}

impl From<NamedPlant> for Json {
    fn from(plant: NamedPlant) -> Json {
        let named = plant.0.into_iter().map(|(name, value)| match value {
            NamedValue::Number(number, _) => (ObjectKey::Text(name), Json::Number(number)),
            NamedValue::Measurement(own) => (ObjectKey::Text(name), Json::Text(own)),
            NamedValue::Added => (ObjectKey::Text(name), Json::Text(ADDED.to_string())),
        });
        Json::Object(Object(named.collect()))
    }
}
