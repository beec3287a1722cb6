//! Conversion of each description of a table into a part of the schema.

use serde_json::{Value, json};

use super::quantity::{ANY, described, number, whole};
use super::table::{SchemaTable, any_of};
use crate::listing::{Listing, keys_of};
use crate::{DeclaredCylinder, DeclaredPipe, HoseProperties, Valve};
use phea_quantity::{MotionKind, Price, PricedBy, price_pattern};
use phea_table::CatalogueKind;
use phea_table::Formula;
use phea_table::{FormulaShape, Kinds, NamedNumber, ValueForm, Variants, Visitor};
use phea_table::{Key, Motions};

/// Builder of the schema, table by table.
#[derive(Default)]
pub(super) struct SchemaWriter {
    /// Open tables, the innermost last.
    tables: Vec<SchemaTable>,
    /// Form in which values with several forms are currently described.
    form: Option<ValueForm>,
    /// True if the current table has such a value.
    has_forms: bool,
    /// Motion of the rig, if the described keys belong to one motion.
    motion: Option<MotionKind>,
    /// Motion of the load of that rig.
    load_motion: Option<MotionKind>,
}

const FORMS: [ValueForm; 3] = [ValueForm::Number, ValueForm::Text, ValueForm::Table];

impl SchemaWriter {
    /// Table, described once for each form of its values.
    pub(super) fn table_of(&mut self, mut visit: impl FnMut(&mut Self)) -> SchemaTable {
        let outside = (self.form, self.has_forms);
        self.tables.push(SchemaTable::default());
        for form in FORMS {
            (self.form, self.has_forms) = (Some(form), false);
            visit(self);
            if !self.has_forms {
                break;
            }
        }
        (self.form, self.has_forms) = outside;
        self.tables.pop().unwrap_or_default()
    }

    fn described_by<T: Default>(&mut self, visit: impl Fn(&mut T, &mut Self)) -> SchemaTable {
        self.table_of(|writer| visit(&mut T::default(), writer))
    }

    fn present(&mut self, change: impl FnOnce(&mut SchemaTable)) {
        if let Some(table) = self.tables.last_mut() {
            change(table);
        }
    }

    pub(super) fn rule(&mut self, rule: Value) {
        self.present(|table| table.rule(rule));
    }

    /// Adds the key of a number in the motion to which it belongs, and the form of a motor in
    /// addition to that of a cylinder if it belongs to either.
    fn numbered(&mut self, key: Key, required: bool, schema: impl Fn(Key) -> Value) {
        let motion = if key.of_load { self.load_motion } else { self.motion };
        let forms = match motion {
            Some(motion) => vec![key.in_motion(Motions::both(motion))],
            None if key.of_motion || key.of_load => {
                vec![key, key.in_motion(Motions::both(MotionKind::Rotary))]
            }
            None => vec![key],
        };
        for form in forms {
            self.property(form, described(form, schema(form)), required);
        }
    }

    /// Adds a key whose value is described completely by `schema`.
    fn property(&mut self, key: Key, mut schema: Value, required: bool) {
        if schema.get("description").is_none() {
            schema["description"] = json!(key.doc);
        }
        self.present(|table| {
            table.property(key.name, schema);
            if required {
                table.require(key.name);
            }
        });
    }
}

/// Schema of a list, each item of which is described completely by `schema`.
fn list(items: &Value) -> Value {
    json!({ "type": "array", "items": items })
}

fn list_of_two(items: &Value) -> Value {
    json!({ "type": "array", "items": items, "minItems": 2, "maxItems": 2 })
}

/// Keys that an entry of the catalogue may have.
fn keys_of_entry(kind: CatalogueKind) -> Vec<&'static str> {
    let mut listing = Listing::of_everything();
    match kind {
        CatalogueKind::Hose => HoseProperties::default().visit(&mut listing),
        CatalogueKind::Valve => Valve::default().visit(&mut listing),
        CatalogueKind::Pipe => DeclaredPipe::default().visit(&mut listing),
        CatalogueKind::Cylinder => DeclaredCylinder::default().visit(&mut listing),
    }
    listing.outermost
}

impl Visitor for SchemaWriter {
    fn names_everything(&self) -> bool {
        true
    }

    fn moves(&mut self, motion: Option<MotionKind>) {
        (self.motion, self.load_motion) = (motion, motion);
    }

    fn load_moves(&mut self, motion: Option<MotionKind>) {
        self.load_motion = motion;
    }

    fn quantity(&mut self, key: Key, _field: &mut f64) {
        self.numbered(key, key.default.is_none(), number);
    }

    fn optional(&mut self, key: Key, _field: &mut Option<f64>) {
        self.numbered(key, false, number);
    }

    fn pair(&mut self, key: Key, _field: &mut Option<[f64; 2]>) {
        self.numbered(key, false, |key| list_of_two(&number(key)));
    }

    fn quantities(&mut self, key: Key, _field: &mut Vec<f64>, required: bool) {
        self.numbered(key, required, |key| list(&number(key)));
    }

    fn complexes(&mut self, key: Key, _field: &mut Vec<[f64; 2]>) {
        let part = number(key);
        self.property(key, list(&json!({ "anyOf": [part, list_of_two(&part)] })), false);
    }

    fn count(&mut self, key: Key, _field: &mut u32) {
        self.property(key, described(key, whole(key)), key.default.is_none());
    }

    fn optional_count(&mut self, key: Key, _field: &mut Option<u32>) {
        self.property(key, described(key, whole(key)), false);
    }

    fn flag(&mut self, key: Key, field: &mut bool) {
        self.property(key, json!({ "type": "boolean", "default": *field }), false);
    }

    fn switch(&mut self, key: Key, _field: &mut bool) {
        self.property(key, json!({ "type": "boolean", "default": true }), false);
    }

    fn text(&mut self, key: Key, _field: &mut Option<String>, required: bool) {
        self.property(key, json!({ "type": "string" }), required);
    }

    fn price(&mut self, key: Key, by: PricedBy, _field: &mut Option<Price>) {
        self.property(key, json!({ "type": "string", "pattern": price_pattern(by) }), false);
    }

    fn texts(&mut self, key: Key, _field: &mut Vec<String>) {
        self.property(key, list(&json!({ "type": "string" })), false);
    }

    fn choice<T: Copy + PartialEq>(
        &mut self,
        key: Key,
        words: &'static [(&'static str, T)],
        field: &mut T,
        required: bool,
    ) {
        let all: Vec<&str> = words.iter().map(|(word, _)| *word).collect();
        let mut schema = json!({ "enum": all });
        let default = words.iter().find(|(_, value)| !required && value == field);
        if let Some((word, _)) = default {
            schema["default"] = json!(word);
        }
        self.property(key, schema, required);
    }

    fn variant<T: Variants>(&mut self, key: Key, field: &mut T, required: bool) {
        let all = field.all();
        let words: Vec<&str> = all.iter().map(T::word).collect();
        let mut schema = json!({ "enum": words });
        if !required {
            schema["default"] = json!(field.word());
        }
        self.property(key, schema, required);
        for one in &all {
            self.present(SchemaTable::begin_condition);
            one.clone().visit(self);
            let own = keys_of(one);
            for name in all.iter().filter(|_| T::STRICT).flat_map(keys_of) {
                if !own.contains(&name) {
                    self.present(|table| table.refuse(name));
                }
            }
            let mut condition = json!({ "properties": { key.name: { "const": one.word() } } });
            if required || one.word() != field.word() {
                condition["required"] = json!([key.name]);
            }
            self.present(|table| table.end_condition(&condition));
        }
    }

    fn formula(&mut self, key: Key, _shape: FormulaShape, _field: &mut Option<Formula>, required: bool) {
        self.property(key, json!({ "type": ["string", "number"] }), required);
    }

    fn catalogue(&mut self, key: Key, kind: CatalogueKind, _field: &mut Option<String>) {
        self.present(|table| table.catalogue = Some((key.name, keys_of_entry(kind))));
        self.property(key, json!({ "type": "string" }), false);
    }

    fn table<T: Default>(&mut self, key: Key, _field: &mut Option<T>, visit: impl Fn(&mut T, &mut Self)) {
        let table = self.described_by(visit);
        self.property(key, table.object(), false);
    }

    fn needed_table<T: Default>(&mut self, key: Key, _field: &mut T, visit: impl Fn(&mut T, &mut Self)) {
        let table = self.described_by(visit);
        self.property(key, table.object(), true);
    }

    fn part<T: Default>(&mut self, _field: &mut Option<T>, visit: impl Fn(&mut T, &mut Self)) {
        visit(&mut T::default(), self);
    }

    fn way<T: Default>(
        &mut self,
        chosen_by: &'static [&'static str],
        field: &mut Option<T>,
        visit: impl Fn(&mut T, &mut Self),
    ) {
        // as if none were chosen, so that the requirement of the alternative is stated
        *field = None;
        self.present(SchemaTable::begin_condition);
        visit(&mut T::default(), self);
        self.present(|table| table.end_condition(&any_of(chosen_by)));
    }

    fn lacks(&mut self, ways: &[&[&'static str]], _what: &str) {
        self.present(|table| table.require_one(ways));
    }

    fn one_of(&mut self, keys: &'static [&'static str], needed: bool) {
        self.present(|table| table.require_only_one(keys, needed));
    }

    fn record<T: Default>(&mut self, key: Key, field: &mut Option<T>, visit: impl Fn(&mut T, &mut Self)) {
        *field = None;
        let table = self.described_by(visit);
        self.property(key, json!({ "anyOf": [table.object(), table.array()] }), false);
    }

    fn tables<T: Default>(&mut self, key: Key, _field: &mut Vec<T>, visit: impl Fn(&mut T, &mut Self)) {
        let table = self.described_by(visit);
        self.property(key, list(&table.object()), false);
    }

    fn one_or_more<T: Default>(&mut self, key: Key, _field: &mut Vec<T>, visit: impl Fn(&mut T, &mut Self)) {
        let table = self.described_by(visit).object();
        self.property(key, json!({ "anyOf": [table, list(&table)] }), false);
    }

    fn dictionary<T: Default>(
        &mut self,
        key: Key,
        _name_of: fn(&T) -> &str,
        _field: &mut Vec<T>,
        visit: impl Fn(&mut T, NamedNumber<'_>, &mut Self),
    ) {
        let named = NamedNumber { name: "NAME", key: Key { dimension: &ANY, ..key } };
        let table = self.described_by(|value: &mut T, writer: &mut Self| visit(value, named, writer));
        let object = table.object();
        self.property(key, json!({ "type": "object", "additionalProperties": object }), false);
    }

    fn numbers(&mut self, key: Key, _of: fn(Key) -> Key, _field: &mut Vec<(String, f64)>) {
        let value = number(Key { dimension: &ANY, ..key });
        self.present(|table| table.others = value);
    }

    fn overrides(&mut self, key: Key, _field: &mut Vec<(String, String)>) {
        self.property(key, json!({ "type": "object", "minProperties": 1 }), true);
    }

    /// Visits both sides: each may have the keys that a table lacks, so that nothing is required if
    /// there is a side.
    fn sides<T: Default + Clone + PartialEq>(
        &mut self,
        keys: [Key; 2],
        _kinds: &'static [Kinds],
        _fields: &mut [T; 2],
        visit: impl Fn(&mut T, &mut Self),
    ) {
        let side = self.described_by(visit);
        let names = keys.map(|key| key.name);
        for key in keys {
            self.property(key, side.loose(), false);
        }
        self.rule(json!({ "if": { "not": any_of(&names) }, "then": side.rules() }));
        self.present(|table| {
            for (name, forms) in side.into_properties() {
                forms.into_iter().for_each(|form| table.property(name, form));
            }
        });
    }

    fn form(&mut self, _key: Key, field: ValueForm) -> ValueForm {
        self.has_forms = true;
        self.form.unwrap_or(field)
    }
}
