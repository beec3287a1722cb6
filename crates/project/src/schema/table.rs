//! Table of the project file as an object of the schema, during its construction.

use serde_json::{Map, Value, json};

/// Table: its keys, and its requirements.
#[derive(Debug)]
pub(super) struct SchemaTable {
    /// Keys with all possible forms of their values, in the order in which they are read.
    properties: Vec<(&'static str, Vec<Value>)>,
    /// Schema of the values of all other keys.
    pub(super) others: Value,
    /// Rules, the innermost condition last.
    blocks: Vec<ConditionalRequirement>,
    /// Key that names an entry of the catalogue, and the keys that the entry may have.
    pub(super) catalogue: Option<(&'static str, Vec<&'static str>)>,
}

/// Rule that applies under a condition.
#[derive(Debug, Default)]
struct ConditionalRequirement {
    required: Vec<&'static str>,
    /// Keys that are required unless the catalogue supplies them.
    required_or_catalogued: Vec<&'static str>,
    refused: Vec<&'static str>,
    rules: Vec<Value>,
}

impl Default for SchemaTable {
    fn default() -> Self {
        SchemaTable {
            properties: Vec::new(),
            others: Value::Bool(false),
            blocks: vec![ConditionalRequirement::default()],
            catalogue: None,
        }
    }
}

/// Requires at least one of these keys.
pub(super) fn any_of(names: &[&str]) -> Value {
    match names {
        [only] => json!({ "required": [only] }),
        several => {
            json!({ "anyOf": several.iter().map(|name| json!({ "required": [name] })).collect::<Vec<_>>() })
        }
    }
}

impl SchemaTable {
    /// Adds a key, or another form of its value.
    pub(super) fn property(&mut self, name: &'static str, schema: Value) {
        match self.properties.iter_mut().find(|(known, _)| *known == name) {
            Some((_, forms)) if forms.contains(&schema) => {}
            Some((_, forms)) => forms.push(schema),
            None => self.properties.push((name, vec![schema])),
        }
    }

    pub(super) fn require(&mut self, name: &'static str) {
        let catalogued = self.is_catalogued(name);
        if let Some(block) = self.blocks.last_mut() {
            let names = if catalogued { &mut block.required_or_catalogued } else { &mut block.required };
            if !names.contains(&name) {
                names.push(name);
            }
        }
    }

    /// Requires one of several groups of keys.
    pub(super) fn require_one(&mut self, groups: &[&[&'static str]]) {
        let mut all: Vec<Value> = groups.iter().map(|group| json!({ "required": group })).collect();
        if let Some((name, _)) = self
            .catalogue
            .as_ref()
            .filter(|_| groups.iter().flat_map(|group| *group).all(|name| self.is_catalogued(name)))
        {
            all.push(json!({ "required": [name] }));
        }
        self.rule(json!({ "anyOf": all }));
    }

    /// Requires exactly one of several keys; or none, unless one is needed and no entry of the
    /// catalogue has it.
    pub(super) fn require_only_one(&mut self, names: &[&str], needed: bool) {
        let each = names.iter().map(|name| json!({ "required": [name] }));
        let entry = self.catalogue.as_ref().filter(|_| names.iter().all(|name| self.is_catalogued(name)));
        let none = match (needed, entry) {
            (false, _) => Some(json!({ "not": any_of(names) })),
            (true, Some((entry, _))) => Some(json!({ "required": [entry], "not": any_of(names) })),
            (true, None) => None,
        };
        self.rule(json!({ "oneOf": each.chain(none).collect::<Vec<_>>() }));
    }

    pub(super) fn refuse(&mut self, name: &'static str) {
        if let Some(block) = self.blocks.last_mut().filter(|block| !block.refused.contains(&name)) {
            block.refused.push(name);
        }
    }

    pub(super) fn rule(&mut self, rule: Value) {
        if let Some(block) = self.blocks.last_mut().filter(|block| !block.rules.contains(&rule)) {
            block.rules.push(rule);
        }
    }

    /// Begins rules that apply only under a condition.
    pub(super) fn begin_condition(&mut self) {
        self.blocks.push(ConditionalRequirement::default());
    }

    /// Ends the rules under a condition.
    pub(super) fn end_condition(&mut self, condition: &Value) {
        let Some(block) = self.blocks.pop() else { return };
        let then = block.schema(self.catalogue.as_ref().map(|(name, _)| *name));
        if then != json!({}) {
            self.rule(json!({ "if": condition, "then": then }));
        }
    }

    fn is_catalogued(&self, name: &str) -> bool {
        self.catalogue.as_ref().is_some_and(|(_, names)| names.contains(&name))
    }

    /// Keys with their forms.
    pub(super) fn into_properties(self) -> Vec<(&'static str, Vec<Value>)> {
        self.properties
    }

    /// Keys without the rules.
    pub(super) fn loose(&self) -> Value {
        json!({ "type": "object", "properties": self.properties_in_json(), "additionalProperties": self.others })
    }

    /// Rules of the table.
    pub(super) fn rules(&self) -> Value {
        let name = self.catalogue.as_ref().map(|(name, _)| *name);
        self.blocks.first().map_or(json!({}), |block| block.schema(name))
    }

    /// Complete schema. Rules follow an empty `if`, because editors do not find keys to offer next
    /// to an `allOf`.
    pub(super) fn object(&self) -> Value {
        let mut schema = self.loose();
        let mut rules = self.rules();
        if let Some(required) = rules.as_object_mut().and_then(|members| members.remove("required")) {
            schema["required"] = required;
        }
        if rules != json!({}) {
            schema["if"] = json!({});
            schema["then"] = rules;
        }
        schema
    }

    /// Array of its values in the order of its keys.
    pub(super) fn array(&self) -> Value {
        let items: Vec<Value> = self.properties.iter().map(|(_, forms)| one_of(forms)).collect();
        let least = self.blocks.first().map_or(0, |block| block.required.len());
        json!({ "type": "array", "items": items, "minItems": least, "additionalItems": false })
    }

    fn properties_in_json(&self) -> Value {
        let named = self.properties.iter().map(|(name, forms)| ((*name).to_string(), one_of(forms)));
        Value::Object(named.collect::<Map<_, _>>())
    }
}

/// Value of any of these forms, with the description of the first.
fn one_of(forms: &[Value]) -> Value {
    match forms {
        [only] => only.clone(),
        [first, ..] => {
            let mut schema = json!({ "anyOf": forms });
            if let Some(text) = first.get("description") {
                schema["description"] = text.clone();
            }
            schema
        }
        [] => json!({}),
    }
}

impl ConditionalRequirement {
    fn schema(&self, catalogue: Option<&str>) -> Value {
        let mut schema = Map::new();
        let mut rules = self.rules.clone();
        if !self.required.is_empty() {
            schema.insert("required".to_string(), json!(self.required));
        }
        if let Some(name) = catalogue.filter(|_| !self.required_or_catalogued.is_empty()) {
            let all = &self.required_or_catalogued;
            rules.push(json!({ "anyOf": [{ "required": [name] }, { "required": all }] }));
        }
        if !self.refused.is_empty() {
            let refused = self.refused.iter().map(|name| ((*name).to_string(), Value::Bool(false)));
            schema.insert("properties".to_string(), Value::Object(refused.collect()));
        }
        if !rules.is_empty() {
            schema.insert("allOf".to_string(), Value::Array(rules));
        }
        Value::Object(schema)
    }
}
