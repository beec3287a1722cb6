//! Values of answers: their JSON, and its description.
//!
//! `#[derive(Answer)]` implements [`Body`] and [`Describe`] for a struct from the names, types and
//! documentation of its fields. [`words!`](super::words) implements [`Describe`] for an enumeration.

use super::object::{Json, Object, ObjectKey};
use super::shape::{Members, ValueShape};

/// A value that is printed and described.
pub(crate) trait Describe: Sized {
    /// Description of every value.
    fn shape() -> ValueShape;

    /// The value in JSON.
    fn into_json(self) -> Json;
}

/// An object, or a part of one, with its keys.
pub(crate) trait Body: Sized {
    /// Description of the keys.
    fn members() -> Members;

    /// Adds the keys to an object.
    fn put(self, object: &mut Object);

    /// An object with these keys.
    fn into_object(self) -> Object {
        let mut object = Object::new();
        self.put(&mut object);
        object
    }
}

/// The value of a key, which may have a second key with the reason why it is missing.
pub(crate) trait Field: Sized {
    /// Description of the keys.
    fn members(key: ObjectKey, description: &str) -> Members;

    /// Adds the keys to an object.
    fn put(self, key: ObjectKey, object: &mut Object);
}

impl<Value: Describe> Field for Value {
    fn members(key: ObjectKey, description: &str) -> Members {
        Members::one(key, description, Value::shape())
    }

    fn put(self, key: ObjectKey, object: &mut Object) {
        object.push(key, self.into_json());
    }
}

/// A field that is declared optional.
pub(crate) trait Perhaps {
    /// Kind of its value.
    type Value;
}

impl<Value> Perhaps for Option<Value> {
    type Value = Value;
}

/// The keys of a part that an object may lack.
impl<Part: Body> Body for Option<Part> {
    fn members() -> Members {
        Part::members().optional()
    }

    fn put(self, object: &mut Object) {
        if let Some(part) = self {
            part.put(object);
        }
    }
}
