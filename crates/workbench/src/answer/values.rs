//! Description of values that are not objects of their own.

use num_complex::Complex64;

use phea_engineering::plant_names::NamedPlant;

use super::describe::Describe;
use super::object::Json;
use super::shape::ValueShape;
use crate::quantity::QuantityName;

macro_rules! describe {
    ($($kind:ty => $shape:ident),* $(,)?) => {
        $(impl Describe for $kind {
            fn shape() -> ValueShape {
                ValueShape::$shape
            }

            fn into_json(self) -> Json {
                Json::from(self)
            }
        })*
    };
}

describe! {
    bool => Flag,
    u8 => Count,
    u32 => Count,
    u64 => Count,
    usize => Count,
    i32 => Integer,
    i64 => Integer,
    f64 => Number,
    Complex64 => Complex,
    char => Text,
    &str => Text,
    String => Text,
    QuantityName => Text,
}

impl<Value: Describe> Describe for Box<Value> {
    fn shape() -> ValueShape {
        Value::shape()
    }

    fn into_json(self) -> Json {
        (*self).into_json()
    }
}

impl<Value: Describe> Describe for Option<Value> {
    fn shape() -> ValueShape {
        ValueShape::Nullable(Box::new(Value::shape()))
    }

    fn into_json(self) -> Json {
        self.map_or(Json::Null, Describe::into_json)
    }
}

impl<Value: Describe> Describe for Vec<Value> {
    fn shape() -> ValueShape {
        ValueShape::List(Box::new(Value::shape()))
    }

    fn into_json(self) -> Json {
        Json::List(self.into_iter().map(Describe::into_json).collect())
    }
}

impl<Value: Describe + Clone> Describe for &[Value] {
    fn shape() -> ValueShape {
        <Vec<Value>>::shape()
    }

    fn into_json(self) -> Json {
        self.to_vec().into_json()
    }
}

impl<Value: Describe, const COUNT: usize> Describe for [Value; COUNT] {
    fn shape() -> ValueShape {
        ValueShape::Array(Box::new(Value::shape()), COUNT)
    }

    fn into_json(self) -> Json {
        Json::List(self.into_iter().map(Describe::into_json).collect())
    }
}

impl<One: Describe, Other: Describe> Describe for (One, Other) {
    fn shape() -> ValueShape {
        ValueShape::Tuple(vec![One::shape(), Other::shape()])
    }

    fn into_json(self) -> Json {
        Json::List(vec![self.0.into_json(), self.1.into_json()])
    }
}

/// The values of a plant by the names of the parameters; a measured plant is a text.
impl Describe for NamedPlant {
    fn shape() -> ValueShape {
        ValueShape::Plant
    }

    fn into_json(self) -> Json {
        Json::from(self)
    }
}
