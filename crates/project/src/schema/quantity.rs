//! Numbers with their units, in a schema.

use phea_quantity::{
    DIMENSIONS, Dimension, Exponents, GAIN, any_quantity_pattern, compound_unit_pattern, print,
    single_unit_pattern,
};
use serde_json::{Map, Value, json};

use phea_table::Key;

/// Dimension of a number that depends on a name given by the user.
pub(super) static ANY: Dimension = Dimension {
    name: "a quantity",
    noun: "quantity",
    exponents: Exponents::NONE,
    units: &[],
    examples: "0.9, \"70 bar\"",
    si: "SI",
};

/// Beginning of a text whose number is above zero.
const POSITIVE: &str = r"^\s*\+?(?:[0.]*[1-9]|inf)";
/// Beginning of a text whose number is not below zero; zero may have a sign.
const NOT_NEGATIVE: &str = r"^\s*(?:[^-\s]|-[0.]*(?:[^0-9.]|$))";

const COMPOUND: &str = "compound_unit";

/// Definitions of the quantities of each dimension as texts.
pub(super) fn definitions() -> Value {
    let mut all = Map::new();
    for dimension in DIMENSIONS {
        let text = json!({ "anyOf": [{ "pattern": single_unit_pattern(dimension) }, reference(COMPOUND)] });
        all.insert(identifier(dimension), text);
    }
    all.insert(COMPOUND.to_string(), json!({ "pattern": compound_unit_pattern() }));
    all.insert(identifier(&ANY), json!({ "pattern": any_quantity_pattern() }));
    Value::Object(all)
}

/// Noun of a dimension, without characters that a pointer cannot contain.
fn identifier(dimension: &Dimension) -> String {
    dimension.noun.replace(|c: char| !c.is_ascii_alphanumeric(), "_")
}

fn reference(name: &str) -> Value {
    json!({ "$ref": format!("#/definitions/{name}") })
}

/// Schema of a number, bare or in text with its unit. The check of the text follows an empty `if`,
/// since keywords next to `$ref` would be ignored.
pub(super) fn number(key: Key) -> Value {
    let mut text = reference(&identifier(key.dimension));
    if key.range.infinity {
        text = json!({ "anyOf": [text, { "pattern": r"^\s*\+?inf\s*$" }] });
    }
    let mut members = json!({ "type": ["number", "string"], "if": {}, "then": text });
    let range = key.range;
    let mut bound = |name: &str, value: f64| members[name] = in_json(value);
    if range.minimum > f64::MIN {
        bound(if range.above_minimum { "exclusiveMinimum" } else { "minimum" }, range.minimum);
    }
    if range.maximum < f64::MAX {
        bound(if range.below_maximum { "exclusiveMaximum" } else { "maximum" }, range.maximum);
    }
    // a gain in dB may be negative
    if range.minimum >= 0.0 && !std::ptr::eq(key.dimension, &GAIN) {
        members["pattern"] = json!(if range.above_minimum { POSITIVE } else { NOT_NEGATIVE });
    }
    members
}

/// Schema of a whole number: only the unit of a text is checked.
pub(super) fn whole(key: Key) -> Value {
    let mut members = number(key);
    members["type"] = json!(["integer", "string"]);
    if key.range.minimum < 0.0 {
        members["minimum"] = json!(0);
    }
    members
}

/// Schema with its meaning and its default.
pub(super) fn described(key: Key, mut members: Value) -> Value {
    let dimension = key.dimension;
    let bare = if dimension.exponents == Exponents::NONE {
        String::new()
    } else {
        format!("; without a unit in {}", dimension.si)
    };
    let kind = capital(dimension.name);
    members["description"] = json!(format!("{}\n\n{kind}, such as {}{bare}.", key.doc, dimension.examples));
    if let Some(default) = key.default {
        members["default"] = default_of(default, dimension);
    }
    members
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

/// Default value as written in the file.
fn default_of(value: f64, dimension: &Dimension) -> Value {
    let text = print(value, dimension);
    match text.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')) {
        Some(quantity) => json!(quantity),
        None => in_json(value),
    }
}

/// Number in JSON, whole ones without a point.
pub(super) fn in_json(value: f64) -> Value {
    if value.fract() == 0.0 && value.abs() < 1e15 { json!(value as i64) } else { json!(value) }
}
