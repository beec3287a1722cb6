//! JSON as a value: what a command says to programs, key by key, and why a number is missing.

use num_complex::Complex64;
use serde::ser::{Serialize, SerializeMap, Serializer};

use super::Number;
use crate::plant_names::{ADDED, NamedPlant, NamedValue};

/// A value of JSON. A number that is not finite is printed as [`Number`] does.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Json {
    Null,
    Flag(bool),
    Count(u64),
    Integer(i64),
    Number(f64),
    Text(String),
    List(Vec<Json>),
    Object(Object),
}

/// An object of JSON, whose keys are in the order in which they were added.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Object(Vec<(String, Json)>);

impl Object {
    /// Without a key.
    pub(crate) fn new() -> Object {
        Object::default()
    }

    /// With one more key.
    pub(crate) fn with(mut self, key: impl Into<String>, value: impl Into<Json>) -> Object {
        self.0.push((key.into(), value.into()));
        self
    }

    /// With a list of what each item is.
    pub(crate) fn each<Item, Value: Into<Json>>(
        self,
        key: &str,
        items: impl IntoIterator<Item = Item>,
        of: impl FnMut(Item) -> Value,
    ) -> Object {
        self.with(key, items.into_iter().map(of).collect::<Vec<Value>>())
    }

    /// With a key that is left out where it has no value.
    pub(crate) fn maybe(self, key: &str, value: Option<impl Into<Json>>) -> Object {
        match value {
            Some(value) => self.with(key, value),
            None => self,
        }
    }

    /// With a key that is `null` where it has no value, and then a second one that says why.
    pub(crate) fn known(self, key: &str, value: Option<impl Into<Json>>, reason: &str) -> Object {
        let missing = value.is_none().then_some(reason);
        self.with(key, value).maybe(&format!("{key}_reason"), missing)
    }

    /// The same, the second key being `null` where there is a value.
    pub(crate) fn told<Value: Into<Json>>(self, key: &str, value: Result<Value, &str>) -> Object {
        let (value, reason) = match value {
            Ok(value) => (Some(value), None),
            Err(reason) => (None, Some(reason)),
        };
        self.with(key, value).with(format!("{key}_reason"), reason)
    }

    /// With all keys of another object behind its own.
    pub(crate) fn and(mut self, other: Object) -> Object {
        self.0.extend(other.0);
        self
    }

    /// Its keys with their values, in their order.
    pub(crate) fn entries(self) -> impl Iterator<Item = (String, Json)> {
        self.0.into_iter()
    }

    /// Printed by itself.
    pub fn print(&self) -> String {
        // every key is a text and every number is finite, so that nothing can fail
        serde_json::to_string_pretty(self).unwrap_or_default()
    }
}

impl Serialize for Object {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (key, value) in &self.0 {
            map.serialize_entry(key, value)?;
        }
        map.end()
    }
}

impl Serialize for Json {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Json::Null => serializer.serialize_none(),
            Json::Flag(value) => serializer.serialize_bool(*value),
            Json::Count(value) => serializer.serialize_u64(*value),
            Json::Integer(value) => serializer.serialize_i64(*value),
            Json::Number(value) => Number(*value).serialize(serializer),
            Json::Text(text) => serializer.serialize_str(text),
            Json::List(items) => serializer.collect_seq(items),
            Json::Object(object) => object.serialize(serializer),
        }
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
            NamedValue::Number(number, _) => (name, Json::Number(number)),
            NamedValue::Measurement(own) => (name, Json::Text(own)),
            NamedValue::Added => (name, Json::Text(ADDED.to_string())),
        });
        Json::Object(Object(named.collect()))
    }
}
