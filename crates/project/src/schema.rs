//! JSON Schema of the project file, for editors, from the descriptions that read it.
//!
//! The schema follows draft 7, the newest that TOML editors support. Conditions on numbers or on
//! several tables are left to the reader: the schema accepts every file that the reader accepts,
//! and rejects errors of structure.

mod quantity;
mod table;
mod writer;

use serde_json::{Value, json};

use super::{DeclaredActuator, Project};
use quantity::definitions;
use writer::SchemaWriter;

/// JSON Schema of the project file.
///
/// # Example
/// ```
/// let schema = phea_project::schema();
/// let pressure = &schema["properties"]["supply"]["properties"]["pressure"];
/// assert_eq!(pressure["exclusiveMinimum"], 0);
/// assert!(pressure["description"].as_str().is_some_and(|text| text.contains("70 bar")));
/// ```
pub fn schema() -> Value {
    let mut writer = SchemaWriter::default();
    let mut project = Project::default();
    let table = writer.table_of(|writer| {
        project.visit_system(writer);
        project.visit_requirements(writer);
        what_is_described(writer);
    });
    let mut schema = table.object();
    if let Value::Object(members) = &mut schema {
        members.insert("$schema".to_string(), json!("http://json-schema.org/draft-07/schema#"));
        members.insert("title".to_string(), json!("Project file of phea"));
        members.insert("description".to_string(), json!("A rig, or any other plant, and its requirements."));
        members.insert("definitions".to_string(), definitions());
    }
    schema
}

/// Requires either a complete actuator, or a plant, or measured plants.
fn what_is_described(writer: &mut SchemaWriter) {
    let measured =
        json!({ "required": ["family"], "properties": { "family": { "required": ["measured"] } } });
    let plant = json!({ "required": ["plant"] });
    let moving = DeclaredActuator::MOVING.map(|name| json!({ "required": [name] }));
    let actuator: Vec<&str> = DeclaredActuator::tables().collect();
    let other: Vec<&str> = actuator.iter().chain(&["plant", "uncertainty"]).copied().collect();
    writer.rule(json!({
        "if": measured,
        "then": without(&other),
        "else": { "if": plant, "then": without(&actuator), "else": { "required": DeclaredActuator::REQUIRED, "oneOf": moving } },
    }));
}

/// Schema without any of these keys.
fn without(names: &[&str]) -> Value {
    let refused = names.iter().map(|name| ((*name).to_string(), Value::Bool(false)));
    json!({ "properties": refused.collect::<serde_json::Map<_, _>>() })
}
