use serde::{Serialize, Serializer};

/// A number in an answer: JSON has no infinity and no NaN, so infinity is the string "inf" and a
/// missing one `null`.
///
/// # Example
/// ```
/// use phea_workbench::answer::Number;
/// let text = |value| serde_json::to_string(&Number(value)).unwrap();
/// assert_eq!(text(1.5), "1.5");
/// assert_eq!(text(f64::INFINITY), "\"inf\"");
/// assert_eq!(text(f64::NAN), "null");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Number(pub f64);

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0 {
            value if value.is_finite() => serializer.serialize_f64(value),
            f64::INFINITY => serializer.serialize_str("inf"),
            f64::NEG_INFINITY => serializer.serialize_str("-inf"),
            _ => serializer.serialize_none(),
        }
    }
}
