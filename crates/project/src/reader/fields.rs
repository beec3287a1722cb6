//! Reading of each description of a table.

use super::{Hit, Layer, Reader, not_one};
use crate::Origin;
use crate::listing::keys_of;
use crate::setting;
use crate::text::RawFinding;
use crate::toml_text::in_toml;
use crate::tree::{TreeNode, Value};
use phea_quantity::spelling::nearest;
use phea_quantity::{MotionKind, Price, PricedBy};
use phea_table::CatalogueKind;
use phea_table::Formula;
use phea_table::{FormulaShape, Kinds, NamedNumber, ValueForm, Variants, Visitor};
use phea_table::{Key, Motions};

/// Keys of a catalogue entry that are ignored if the project states the first: a pressure belongs
/// to its flow, and areas and rods are stated in one way.
const REPLACED: [(&str, &[&str]); 5] = [
    ("tare_flow", &["tare_pressure"]),
    ("rod_diameter", &["rod_diameters"]),
    ("rod_diameters", &["rod_diameter"]),
    ("piston_area", &["piston_diameter", "rod_diameter", "rod_diameters"]),
    ("piston_areas", &["piston_diameter", "rod_diameter", "rod_diameters"]),
];

impl Visitor for Reader<'_> {
    fn moves(&mut self, motion: Option<MotionKind>) {
        self.motion = Motions::both(motion.unwrap_or_default());
    }

    fn load_moves(&mut self, motion: Option<MotionKind>) {
        self.motion.load = motion.unwrap_or_default();
    }

    fn quantity(&mut self, key: Key, field: &mut f64) {
        if let Some(hit) = self.find(key) {
            let origin = self.origin(key, hit);
            self.record_origin(key, origin);
            *field = self.number_or_none(key, hit.node);
        } else if let Some(default) = key.default {
            if !self.depends_on_other_file() {
                self.record_origin(key, Origin::Default);
            }
            *field = default;
        } else {
            self.missing(key);
        }
    }

    fn optional(&mut self, key: Key, field: &mut Option<f64>) {
        let Some(hit) = self.find(key) else { return };
        let origin = self.origin(key, hit);
        self.record_origin(key, origin);
        *field = Some(self.number_or_none(key, hit.node));
    }

    fn pair(&mut self, key: Key, field: &mut Option<[f64; 2]>) {
        let Some(hit) = self.find(key) else { return };
        let Value::List(items) = &hit.node.value else {
            return self.wrong_kind(key, "a list of two", hit.node);
        };
        let origin = self.origin(key, hit);
        self.record_origin(key, origin);
        let [first, second] = items.as_slice() else {
            let message = format!("`{}` must have two values, not {}", key.name, items.len());
            return self.findings.push(RawFinding::error(hit.node.place, message));
        };
        *field = Some([first, second].map(|item| self.number_or_none(key, item)));
    }

    fn quantities(&mut self, key: Key, field: &mut Vec<f64>, required: bool) {
        let Some(hit) = self.find(key) else {
            if required {
                self.missing(key);
            }
            return;
        };
        let Value::List(items) = &hit.node.value else { return self.wrong_kind(key, "a list", hit.node) };
        *field = items.iter().map(|item| self.number_or_none(key, item)).collect();
    }

    fn complexes(&mut self, key: Key, field: &mut Vec<[f64; 2]>) {
        let Some(hit) = self.find(key) else { return };
        let Value::List(items) = &hit.node.value else { return self.wrong_kind(key, "a list", hit.node) };
        *field = items.iter().filter_map(|item| self.complex(key, item)).collect();
    }

    fn count(&mut self, key: Key, field: &mut u32) {
        let Some(hit) = self.find(key) else {
            match key.default {
                Some(default) => *field = default as u32,
                None => self.missing(key),
            }
            return;
        };
        *field = self.whole(key, hit.node).unwrap_or(*field);
    }

    fn optional_count(&mut self, key: Key, field: &mut Option<u32>) {
        if let Some(hit) = self.find(key) {
            *field = self.whole(key, hit.node);
        }
    }

    fn flag(&mut self, key: Key, field: &mut bool) {
        let Some(hit) = self.find(key) else { return };
        match hit.node.value {
            Value::Flag(value) => *field = value,
            _ => self.wrong_kind(key, "true or false", hit.node),
        }
    }

    fn text(&mut self, key: Key, field: &mut Option<String>, required: bool) {
        match self.find(key) {
            Some(hit) => match &hit.node.value {
                Value::Text(text) => *field = Some(text.clone()),
                _ => self.wrong_kind(key, "a text", hit.node),
            },
            None if required => self.missing(key),
            None => {}
        }
    }

    fn price(&mut self, key: Key, by: PricedBy, field: &mut Option<Price>) {
        if let Some(hit) = self.find(key) {
            *field = self.read_price(key, by, hit.node);
        }
    }

    fn texts(&mut self, key: Key, field: &mut Vec<String>) {
        let Some(hit) = self.find(key) else { return };
        let Value::List(items) = &hit.node.value else {
            return self.wrong_kind(key, "a list of texts", hit.node);
        };
        for item in items {
            match &item.value {
                Value::Text(text) => field.push(text.clone()),
                _ => self.wrong_kind(key, "a list of texts", item),
            }
        }
    }

    fn choice<T: Copy + PartialEq>(
        &mut self,
        key: Key,
        words: &'static [(&'static str, T)],
        field: &mut T,
        required: bool,
    ) {
        let Some(hit) = self.find(key) else {
            if required {
                self.missing(key);
                self.leave_unclear();
            }
            return;
        };
        let all: Vec<&str> = words.iter().map(|(word, _)| *word).collect();
        match self.word(key, hit.node, &all).and_then(|index| words.get(index)) {
            Some((_, value)) => *field = *value,
            None if required => self.leave_unclear(),
            None => {}
        }
    }

    fn variant<T: Variants>(&mut self, key: Key, field: &mut T, required: bool) {
        let all = field.all();
        let words: Vec<&str> = all.iter().map(T::word).collect();
        let chosen = match self.find(key) {
            Some(hit) => self.word(key, hit.node, &words),
            None if required => {
                self.missing(key);
                None
            }
            None => words.iter().position(|word| *word == field.word()),
        };
        match chosen.and_then(|index| all.get(index)) {
            Some(chosen) => {
                *field = chosen.clone();
                self.choose(Some(format!("{} \"{}\"", key.name, chosen.word())));
                field.visit(self);
                self.choose(None);
                self.without_effect(key, field, &all);
            }
            None => {
                self.leave_unclear();
                // a key that may belong to another variant does not count as unknown
                all.iter().flat_map(keys_of).for_each(|name| self.know(name));
            }
        }
    }

    fn formula(&mut self, key: Key, shape: FormulaShape, field: &mut Option<Formula>, required: bool) {
        match self.find(key) {
            Some(hit) => *field = self.read_formula(key, shape, hit.node),
            None if required => self.missing(key),
            None => {}
        }
    }

    fn catalogue(&mut self, key: Key, kind: CatalogueKind, field: &mut Option<String>) {
        let catalogue = self.catalogue;
        self.text(key, field, false);
        let Some(name) = field.clone() else { return };
        if self.partial {
            return;
        }
        if let Some(entry) = catalogue.find(kind, &name) {
            if !self.catalogue_files.contains(&entry.file) {
                self.catalogue_files.push(entry.file.clone());
            }
            if let Some(frame) = self.frames.last_mut() {
                let own =
                    |name: &str| frame.layers.first().is_some_and(|table| table.node.get(name).is_some());
                let replaced = REPLACED.iter().filter(|(name, _)| own(name));
                let hidden = replaced.flat_map(|(_, others)| others.iter().copied()).collect();
                frame.layers.push(Layer { node: &entry.values, hidden, entry: Some(entry) });
            }
            return;
        }
        if let Some(frame) = self.frames.last_mut() {
            frame.lost = true;
        }
        let names: Vec<&str> = catalogue.names(kind);
        let help = match nearest(&name, names.iter().copied()) {
            Some(near) => format!("did you mean \"{near}\"?"),
            None => format!("the catalogue has {}", names.join(", ")),
        };
        let place = self.places.get(&self.path(key.name)).copied().unwrap_or_default();
        let message = format!("no {} called \"{name}\" in the catalogue", kind.name());
        self.findings.push(RawFinding::error(place, message).help(help));
    }

    fn table<T: Default>(&mut self, key: Key, field: &mut Option<T>, visit: impl Fn(&mut T, &mut Self)) {
        let Some(hit) = self.find(key) else { return };
        let path = self.path(key.name);
        if self.enter(key, hit, path) {
            let mut value = T::default();
            visit(&mut value, self);
            self.close();
            *field = Some(value);
        }
    }

    fn needed_table<T: Default>(&mut self, key: Key, field: &mut T, visit: impl Fn(&mut T, &mut Self)) {
        if self.find(key).is_none() {
            return self.missing(key);
        }
        let mut value = None;
        self.table(key, &mut value, visit);
        *field = value.unwrap_or_default();
    }

    fn part<T: Default>(&mut self, field: &mut Option<T>, visit: impl Fn(&mut T, &mut Self)) {
        let mut value = T::default();
        if self.parts {
            visit(&mut value, self);
            *field = Some(value);
        }
    }

    fn way<T: Default>(
        &mut self,
        chosen_by: &'static [&'static str],
        field: &mut Option<T>,
        visit: impl Fn(&mut T, &mut Self),
    ) {
        let chosen = chosen_by.iter().find(|name| self.is_there(name));
        let known = self.frames.last().map_or(0, |frame| frame.requested.len());
        let mut value = T::default();
        if chosen.is_none() || self.is_lost() {
            self.pass_over(Some(Vec::new()));
        }
        self.choose(chosen.map(|name| format!("`{name}`")));
        visit(&mut value, self);
        self.choose(None);
        self.pass_over(None);
        *field = chosen.map(|_| value);
        if field.is_none() {
            self.without_choice(chosen_by, known);
        }
    }

    fn lacks(&mut self, ways: &[&[&'static str]], what: &str) {
        let refused = ways.iter().any(|keys| keys.iter().all(|name| self.is_there(name)));
        if !self.takes_absent() && !refused {
            let message = format!("missing {what}{}", self.of_table());
            self.findings.push(RawFinding::error(self.place(), message).consequence());
        }
    }

    fn one_of(&mut self, keys: &'static [&'static str], needed: bool) {
        if self.depends_on_other_file() {
            return;
        }
        self.at_most_one(keys);
        if needed && !self.takes_absent_of(keys) {
            let (last, others) = keys.split_last().map_or(("", keys), |(last, others)| (*last, others));
            let others = others.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
            let message = format!("missing {others} or `{last}`{}", self.of_table());
            self.findings.push(RawFinding::error(self.place(), message).consequence());
        }
    }

    fn record<T: Default>(&mut self, key: Key, field: &mut Option<T>, visit: impl Fn(&mut T, &mut Self)) {
        let Some(hit) = self.find(key) else { return };
        let path = self.path(key.name);
        let entered = match &hit.node.value {
            Value::List(items) => {
                self.open(path, hit.node.place, Vec::new());
                if let Some(frame) = self.frames.last_mut() {
                    frame.layers.push(Layer { node: hit.node, hidden: Vec::new(), entry: hit.entry });
                    frame.in_order = Some(items.iter());
                }
                true
            }
            _ => self.enter_as(key, hit, path, "a table, or an array of its values"),
        };
        if entered {
            let mut value = T::default();
            visit(&mut value, self);
            self.close();
            *field = Some(value);
        }
    }

    fn tables<T: Default>(&mut self, key: Key, field: &mut Vec<T>, visit: impl Fn(&mut T, &mut Self)) {
        let Some(hit) = self.find(key) else { return };
        let Value::List(items) = &hit.node.value else {
            let message = format!("`{}` must be a list of tables, not {}", key.name, hit.node.kind());
            let help = format!("write [[{}]] over each", self.path(key.name));
            return self.findings.push(RawFinding::error(hit.node.place, message).help(help));
        };
        let items: Vec<&TreeNode> = items.iter().collect();
        self.each_table(key, &items, hit, field, visit);
    }

    fn word_or_tables<W: Copy + PartialEq, T: Default>(
        &mut self,
        key: Key,
        (words, kinds, help): (&'static [(&'static str, W)], &'static str, &'static str),
        word: &mut W,
        tables: &mut Vec<T>,
        visit: impl Fn(&mut T, &mut Self),
    ) {
        let Some(Hit { node, .. }) = self.find(key) else { return };
        match &node.value {
            Value::Text(_) => self.choice(key, words, word, false),
            Value::List(items) if items.iter().all(|item| matches!(item.value, Value::Table(_))) => {
                self.tables(key, tables, visit);
            }
            _ => self.neither(key, node, (kinds, help)),
        }
    }

    fn one_or_more<T: Default>(&mut self, key: Key, field: &mut Vec<T>, visit: impl Fn(&mut T, &mut Self)) {
        let Some(hit) = self.find(key) else { return };
        let items: Vec<&TreeNode> = match &hit.node.value {
            Value::List(items) => items.iter().collect(),
            Value::Table(_) => vec![hit.node],
            _ => return self.wrong_kind(key, "a table or a list of tables", hit.node),
        };
        self.each_table(key, &items, hit, field, visit);
    }

    fn dictionary<T: Default>(
        &mut self,
        key: Key,
        _name_of: fn(&T) -> &str,
        field: &mut Vec<T>,
        visit: impl Fn(&mut T, NamedNumber<'_>, &mut Self),
    ) {
        let Some(hit) = self.find(key) else { return };
        if !matches!(hit.node.value, Value::Table(_)) {
            return self.wrong_kind(key, "a table", hit.node);
        }
        for entry in hit.node.entries() {
            let Some(number) = self.named.get(&entry.key).copied() else {
                if self.seems_absent(&entry.key) {
                    continue;
                }
                let near = nearest(&entry.key, self.named.keys().map(String::as_str));
                let is_count = self.counts.contains(&entry.key);
                let quoted = self.quoted(key, entry);
                let inside = self.number_inside(&entry.key).filter(|_| quoted.is_none());
                let message = match is_count {
                    true => format!("`{}` is a whole number: only quantities vary", entry.key),
                    false => not_one(&entry.key, "number", inside.is_some()),
                };
                let near = near.filter(|_| !is_count).map(|name| format!("did you mean `{name}`?"));
                let help = quoted.or(inside).or(near);
                self.findings.push(RawFinding::error(entry.key_place, message).maybe_help(help));
                continue;
            };
            let path = format!("{}.{}", self.path(key.name), entry.key);
            self.places.insert(path.clone(), entry.key_place);
            if self.enter(number, Hit { node: &entry.node, entry: None }, path) {
                let mut value = T::default();
                visit(&mut value, NamedNumber { name: &entry.key, key: number }, self);
                self.close();
                field.push(value);
            }
        }
    }

    fn numbers(&mut self, key: Key, of: fn(Key) -> Key, field: &mut Vec<(String, f64)>) {
        let entries =
            self.frames.last().and_then(|frame| frame.layers.first()).map(|layer| layer.node.entries());
        for entry in entries.unwrap_or_default() {
            let Some(number) = self.named.get(&entry.key).copied() else {
                if self.seems_absent(&entry.key) {
                    continue;
                }
                let near = nearest(&entry.key, self.named.keys().map(String::as_str));
                let inside = self.number_inside(&entry.key);
                let message = not_one(&entry.key, key.name, inside.is_some());
                let help = inside.or(near.map(|name| format!("did you mean `{name}`?")));
                self.findings.push(RawFinding::error(entry.key_place, message).maybe_help(help));
                continue;
            };
            if let Some(value) = self.number(of(number), &entry.node) {
                field.push((entry.key.clone(), value));
            }
        }
        if let Some(frame) = self.frames.last_mut() {
            frame.layers.clear();
        }
    }

    fn overrides(&mut self, key: Key, field: &mut Vec<(String, String)>) {
        let Some(hit) = self.find(key) else { return self.missing(key) };
        if !matches!(hit.node.value, Value::Table(_)) {
            return self.wrong_kind(key, "a table", hit.node);
        }
        let mut wrong = Vec::new();
        let settings = setting::of_table(hit.node, self.findings, &mut wrong);
        if settings.is_empty() && wrong.is_empty() {
            wrong.push(RawFinding::error(hit.node.place, format!("`{}` sets nothing", self.path(key.name))));
        }
        for setting in settings {
            match in_toml(setting.value) {
                Some(value) => field.push((setting.path(), value)),
                None => wrong.push(RawFinding::error(setting.value.place, "no key accepts a date")),
            }
        }
        wrong.into_iter().for_each(|found| self.findings.push(found));
    }

    fn sides<T: Default + Clone + PartialEq>(
        &mut self,
        keys: [Key; 2],
        kinds: &'static [Kinds],
        fields: &mut [T; 2],
        visit: impl Fn(&mut T, &mut Self),
    ) {
        let Some(parent) = self.frames.last() else { return };
        let (inherited, path, place) = (parent.layers.clone(), parent.path.clone(), parent.place);
        let hits = keys.map(|key| self.find(key));
        let mut requested = Vec::new();
        for ((key, hit), field) in keys.into_iter().zip(hits).zip(fields) {
            let (own, side_path, side_place) = match hit {
                Some(Hit { node, .. }) if matches!(node.value, Value::Table(_)) => {
                    (Some(node), self.path(key.name), node.place)
                }
                Some(hit) => {
                    self.wrong_kind(key, "a table", hit.node);
                    continue;
                }
                None => (None, path.clone(), place),
            };
            let chooses = |kinds: &&Kinds| {
                own.is_some_and(|node| kinds.chosen_by.iter().any(|name| node.get(name).is_some()))
            };
            let hidden: Vec<&str> =
                kinds.iter().filter(chooses).flat_map(|kinds| kinds.keys).copied().collect();
            let mut layers: Vec<Layer<'_>> = Vec::new();
            layers.extend(own.map(|node| Layer { node, hidden: Vec::new(), entry: None }));
            layers.extend(inherited.iter().map(|layer| Layer { hidden: hidden.clone(), ..layer.clone() }));
            let inherits_only = own.is_none();
            self.open(side_path, side_place, layers);
            *field = T::default();
            visit(field, self);
            requested.extend(if inherits_only { self.leave() } else { self.close() });
        }
        if let Some(frame) = self.frames.last_mut() {
            frame.requested.extend(requested);
        }
    }

    fn form(&mut self, key: Key, _field: ValueForm) -> ValueForm {
        let Some(hit) = self.find(key) else { return ValueForm::Number };
        match &hit.node.value {
            Value::Table(_) => ValueForm::Table,
            Value::Text(text) if self.reads_as_formula(key, text) => ValueForm::Text,
            _ => ValueForm::Number,
        }
    }
}
