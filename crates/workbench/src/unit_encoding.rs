//! Display units between computers: symbol and size.

use serde::de::{Deserialize, Deserializer, Error};
use serde::ser::{Serialize, Serializer};

use crate::quantity::{DisplayUnit, known_unit};

pub(crate) fn serialize<S: Serializer>(unit: &DisplayUnit, serializer: S) -> Result<S::Ok, S::Error> {
    (unit.symbol, unit.in_si).serialize(serializer)
}

pub(crate) fn deserialize<'d, D: Deserializer<'d>>(deserializer: D) -> Result<DisplayUnit, D::Error> {
    let (symbol, in_si) = <(String, f64)>::deserialize(deserializer)?;
    known_unit(&symbol, in_si).ok_or_else(|| D::Error::custom(format!("no unit `{symbol}`")))
}
