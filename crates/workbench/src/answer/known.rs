//! Values that may not exist, each with the reason, and values under names from a list.

use std::marker::PhantomData;

use super::describe::{Body, Describe, Field};
use super::object::{Json, Object, ObjectKey};
use super::shape::{Members, ValueShape};

/// A value, or the reason why there is none: `null`, and then a second key with the reason.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct OrReason<Value>(pub(crate) Result<Value, String>);

impl<Value> OrReason<Value> {
    /// The value, or this reason.
    pub(crate) fn new(value: Option<Value>, reason: impl Into<String>) -> OrReason<Value> {
        OrReason(value.ok_or_else(|| reason.into()))
    }
}

impl<Value: Describe> Field for OrReason<Value> {
    fn members(key: ObjectKey, description: &str) -> Members {
        value_members::<Value>(&key, description).and(reason_members(&key, ValueShape::Text).optional())
    }

    fn put(self, key: ObjectKey, object: &mut Object) {
        let reason_key = key.reason();
        match self.0 {
            Ok(value) => object.push(key, value.into_json()),
            Err(reason) => {
                object.push(key, Json::Null);
                object.push(reason_key, reason);
            }
        }
    }
}

/// Value or the reason for which it is missing, always with both keys: one of them is `null`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Reasoned<Value>(pub(crate) Result<Value, String>);

impl<Value> Reasoned<Value> {
    /// The value, or this reason.
    pub(crate) fn new(value: Option<Value>, reason: impl Into<String>) -> Reasoned<Value> {
        Reasoned(value.ok_or_else(|| reason.into()))
    }

    /// The value, or the reason that is known.
    pub(crate) fn of(value: Result<Value, impl Into<String>>) -> Reasoned<Value> {
        Reasoned(value.map_err(Into::into))
    }
}

impl<Value: Describe> Field for Reasoned<Value> {
    fn members(key: ObjectKey, description: &str) -> Members {
        let reason = ValueShape::Nullable(Box::new(ValueShape::Text));
        value_members::<Value>(&key, description).and(reason_members(&key, reason))
    }

    fn put(self, key: ObjectKey, object: &mut Object) {
        let reason_key = key.reason();
        let (value, reason) = match self.0 {
            Ok(value) => (value.into_json(), None),
            Err(reason) => (Json::Null, Some(reason)),
        };
        object.push(key, value);
        object.push(reason_key, reason);
    }
}

fn value_members<Value: Describe>(key: &ObjectKey, description: &str) -> Members {
    Members::one(key.clone(), description, ValueShape::Nullable(Box::new(Value::shape())))
}

fn reason_members(key: &ObjectKey, shape: ValueShape) -> Members {
    Members::one(key.reason(), "Reason for which the value is absent.", shape)
}

/// An object whose keys were put together before, with the description of its kind.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PutTogether<Kind> {
    object: Object,
    kind: PhantomData<Kind>,
}

impl<Kind: Body> PutTogether<Kind> {
    /// The object that a value of this kind has put together.
    pub(crate) fn new(object: Object) -> PutTogether<Kind> {
        PutTogether { object, kind: PhantomData }
    }
}

impl<Kind: Describe> Describe for PutTogether<Kind> {
    fn shape() -> ValueShape {
        Kind::shape()
    }

    fn into_json(self) -> Json {
        Json::Object(self.object)
    }
}

/// Values under names that follow from the project, such as those of parameters.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Entries<Value>(pub(crate) Vec<(String, Value)>);

impl<Value: Describe> Describe for Entries<Value> {
    fn shape() -> ValueShape {
        ValueShape::Map(Box::new(Value::shape()))
    }

    fn into_json(self) -> Json {
        let mut object = Object::new();
        self.0.into_iter().for_each(|(name, value)| object.push(name, value.into_json()));
        Json::Object(object)
    }
}

/// A list of keys, of which objects have some.
pub(crate) trait KeyList {
    /// True if every object has exactly one of them.
    const ONE: bool = false;

    /// The keys with their descriptions.
    fn keys() -> Vec<(ObjectKey, String)>;
}

/// Values under keys of a list.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Keyed<List, Value> {
    values: Vec<(ObjectKey, Value)>,
    list: PhantomData<List>,
}

impl<List, Value> Keyed<List, Value> {
    /// These values.
    pub(crate) fn new(values: impl IntoIterator<Item = (ObjectKey, Value)>) -> Keyed<List, Value> {
        Keyed { values: values.into_iter().collect(), list: PhantomData }
    }
}

impl<List: KeyList, Value: Field> Body for Keyed<List, Value> {
    fn members() -> Members {
        let members = List::keys().into_iter().map(|(key, text)| Value::members(key, &text));
        match List::ONE {
            true => Members::one_of(members.collect()),
            false => members.fold(Members::default(), Members::and).optional(),
        }
    }

    fn put(self, object: &mut Object) {
        self.values.into_iter().for_each(|(key, value)| value.put(key, object));
    }
}
