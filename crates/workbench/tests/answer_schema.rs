//! Validates answers against the schema of answers, by the part of JSON Schema that it uses.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

use std::sync::OnceLock;

use phea_workbench::command::answers_schema;
use serde_json::{Map, Value};

/// The schema of the answers of all commands.
pub(crate) fn schema() -> &'static Value {
    static SCHEMA: OnceLock<Value> = OnceLock::new();
    SCHEMA.get_or_init(|| serde_json::from_slice(&answers_schema().bytes).unwrap())
}

/// An answer, which must be as the schema describes it.
#[track_caller]
pub(crate) fn parsed(text: &str) -> Value {
    let answer: Value = serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"));
    if let Err(fault) = validated(&answer) {
        panic!("the answer of {} is not as described: {fault}", answer["command"]);
    }
    answer
}

/// Compares an answer with the descriptions of the answers of its command.
pub(crate) fn validated(answer: &Value) -> Result<(), String> {
    let described = schema()["anyOf"].as_array().unwrap().iter();
    // what has no answer has errors, whatever the command
    let command = if answer["errors"].is_array() { &Value::Null } else { &answer["command"] };
    let described: Vec<&Value> = described.filter(|one| is_of(one, command)).collect();
    match described.as_slice() {
        [] => Err("the command has no described answer".to_string()),
        [only] => conforms(only, answer, "answer"),
        several if several.iter().any(|one| conforms(one, answer, "answer").is_ok()) => Ok(()),
        several => Err(several
            .iter()
            .filter_map(|one| conforms(one, answer, "answer").err())
            .collect::<Vec<String>>()
            .join("; or ")),
    }
}

/// True for the description of an answer of this command, or of any if that is null.
fn is_of(described: &Value, command: &Value) -> bool {
    referenced(described["$ref"].as_str().unwrap())["properties"]["command"]["const"] == *command
}

fn referenced(path: &str) -> &'static Value {
    let found = path.strip_prefix('#').and_then(|pointer| schema().pointer(pointer));
    found.unwrap_or_else(|| panic!("{path} is not defined"))
}

/// Compares a value with a schema; the fault of a value at `at`.
pub(crate) fn conforms(schema: &Value, value: &Value, at: &str) -> Result<(), String> {
    for (keyword, rule) in schema.as_object().unwrap() {
        let is_satisfied = match keyword.as_str() {
            "description" | "title" | "properties" | "minItems" | "maxItems" => continue,
            "$ref" => {
                conforms(referenced(rule.as_str().unwrap()), value, at)?;
                continue;
            }
            "type" if *rule == "object" && is_open(schema) => return Err(format!("{at} may have any key")),
            "type" => is_kind(rule.as_str().unwrap(), value),
            "const" => value == rule,
            "enum" => rule.as_array().unwrap().contains(value),
            "minimum" => value.as_f64() >= rule.as_f64(),
            "required" => {
                let keys = rule.as_array().unwrap().iter().map(|key| key.as_str().unwrap());
                if let Some(missing) = keys.into_iter().find(|key| value.get(key).is_none()) {
                    return Err(format!("{at} lacks {missing}"));
                }
                continue;
            }
            "additionalProperties" => {
                members(schema, rule, value, at)?;
                continue;
            }
            "items" => {
                items(schema, rule, value, at)?;
                continue;
            }
            "allOf" => {
                rule.as_array().unwrap().iter().try_for_each(|one| conforms(one, value, at))?;
                continue;
            }
            "anyOf" => {
                any_of(rule.as_array().unwrap(), value, at)?;
                continue;
            }
            other => panic!("the validator does not know the keyword {other}"),
        };
        if !is_satisfied {
            return Err(format!("{at} is {value}, which is not {keyword} {rule}"));
        }
    }
    Ok(())
}

/// True for an object whose keys are not described.
fn is_open(schema: &Value) -> bool {
    ["properties", "additionalProperties"].iter().all(|keyword| schema.get(keyword).is_none())
}

fn is_kind(kind: &str, value: &Value) -> bool {
    match kind {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "integer" => value.is_i64() || value.is_u64(),
        "number" => value.is_number(),
        "string" => value.is_string(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        other => panic!("the validator does not know the type {other}"),
    }
}

/// The values of an object: of its properties, and of all other keys, which may be forbidden.
fn members(schema: &Value, other: &Value, value: &Value, at: &str) -> Result<(), String> {
    let nothing = Map::new();
    let properties = schema.get("properties").map_or(&nothing, |own| own.as_object().unwrap());
    let Some(object) = value.as_object() else { return Ok(()) };
    for (key, member) in object {
        let at = format!("{at}.{key}");
        match properties.get(key) {
            Some(property) => conforms(property, member, &at)?,
            None if *other == Value::Bool(false) => return Err(format!("{at} is not described")),
            None => conforms(other, member, &at)?,
        }
    }
    Ok(())
}

fn items(schema: &Value, rule: &Value, value: &Value, at: &str) -> Result<(), String> {
    let Some(list) = value.as_array() else { return Ok(()) };
    let count = |keyword: &str| schema.get(keyword).map(|count| count.as_u64().unwrap() as usize);
    if count("minItems").is_some_and(|least| list.len() < least)
        || count("maxItems").is_some_and(|most| list.len() > most)
    {
        return Err(format!("{at} has {} items", list.len()));
    }
    for (index, item) in list.iter().enumerate() {
        let own = rule.get(index).filter(|_| rule.is_array()).unwrap_or(rule);
        conforms(own, item, &format!("{at}[{index}]"))?;
    }
    Ok(())
}

fn any_of(several: &[Value], value: &Value, at: &str) -> Result<(), String> {
    let faults: Vec<String> = several.iter().filter_map(|one| conforms(one, value, at).err()).collect();
    if faults.len() < several.len() {
        return Ok(());
    }
    // a fault deep inside says more than that the value is not null
    Err(faults.into_iter().max_by_key(String::len).unwrap_or_default())
}
