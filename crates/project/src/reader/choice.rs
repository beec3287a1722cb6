//! Variants and ways: their choice, and the keys of those that were not chosen.

use super::{Layer, Reader};
use crate::listing::keys_of;
use crate::text::{Place, RawFinding};
use crate::tree::{TreeNode, Value};
use phea_quantity::spelling::nearest;
use phea_table::Key;
use phea_table::Variants;

/// Variants that have a key, as in `it belongs to model "creeping" or "segments"`.
fn belongs_to<T: Variants>(key: Key, name: &str, all: &[T]) -> String {
    let having = all.iter().filter(|one| keys_of(*one).contains(&name));
    let words: Vec<String> = having.map(|one| format!("\"{}\"", one.word())).collect();
    let words = match words.split_last() {
        Some((last, others)) if !others.is_empty() => format!("{} or {last}", others.join(", ")),
        _ => words.concat(),
    };
    format!("it belongs to {} {words}", key.name)
}

impl<'a> Reader<'a> {
    /// Index of a text among words of which it must be one.
    pub(super) fn word(&mut self, key: Key, node: &TreeNode, words: &[&'static str]) -> Option<usize> {
        let all = words.iter().map(|word| format!("\"{word}\"")).collect::<Vec<_>>().join(", ");
        let Value::Text(text) = &node.value else {
            let path = self.path(key.name);
            self.refused.push(path);
            self.wrong_kind(key, &format!("one of {all}"), node);
            return None;
        };
        let found = words.iter().position(|word| word == text);
        if found.is_none() {
            let message = format!("`{}` cannot be \"{text}\"", key.name);
            let path = self.path(key.name);
            self.refused.push(path);
            let near = nearest(text, words.iter().copied());
            let help = near.map(|word| format!("did you mean \"{word}\"?"));
            let expected = format!("one of {all}");
            self.findings.push(RawFinding::error(node.place, message).expected(expected).maybe_help(help));
        }
        found
    }

    /// Rejects a value that is neither a word nor a list of tables.
    pub(super) fn neither(&mut self, key: Key, node: &TreeNode, (kinds, help): (&str, &str)) {
        let is_table = |item: &&TreeNode| matches!(item.value, Value::Table(_));
        let (wrong, expected) = match &node.value {
            Value::List(items) => {
                (items.iter().find(|item| !is_table(item)).unwrap_or(node), "a list of tables")
            }
            _ => (node, kinds),
        };
        let path = self.path(key.name);
        self.refused.push(path);
        let message = format!("`{}` must be {expected}, not {}", key.name, wrong.kind());
        self.findings.push(RawFinding::error(wrong.place, message).help(help));
    }

    /// Records that the kind of the current table is unknown.
    pub(super) fn leave_unclear(&mut self) {
        if let Some(frame) = self.frames.last().filter(|frame| !frame.path.is_empty()) {
            self.unclear.push(frame.path.clone());
        }
    }

    pub(super) fn choose(&mut self, chosen: Option<String>) {
        if let Some(frame) = self.frames.last_mut() {
            frame.chosen = chosen;
        }
    }

    pub(super) fn pass_over(&mut self, keys: Option<Vec<&'static str>>) {
        if let Some(frame) = self.frames.last_mut() {
            frame.passed_over = keys;
        }
    }

    /// Reports keys of other variants in the table; their values must be valid.
    pub(super) fn without_effect<T: Variants>(&mut self, key: Key, chosen: &T, all: &[T]) {
        let mut read = keys_of(chosen);
        for other in all {
            let keys = keys_of(other);
            self.pass_over(Some(read.clone()));
            other.clone().visit(self);
            self.pass_over(None);
            for name in keys.iter().filter(|name| !read.contains(name)) {
                if let Some(place) = self.written(name) {
                    let message = format!("`{name}` has no effect with {} \"{}\"", key.name, chosen.word());
                    let found = if T::STRICT { RawFinding::error } else { RawFinding::warning };
                    self.findings.push(found(place, message).help(belongs_to(key, name, all)));
                }
            }
            read.extend(keys);
        }
    }

    /// Warns about keys read since this number of keys was known, if their way was not chosen.
    pub(super) fn without_choice(&mut self, chosen_by: &[&'static str], known: usize) {
        let requested =
            self.frames.last().and_then(|frame| frame.requested.get(known..)).unwrap_or_default().to_vec();
        let Some(chooses) = chosen_by.first().filter(|_| !self.partial) else { return };
        for name in requested {
            if let Some(place) = self.written(name) {
                let message = format!("`{name}` has no effect without `{chooses}`");
                self.findings.push(RawFinding::warning(place, message));
            }
        }
    }

    /// Rejects every key that is written together with an earlier one, unless its value was already
    /// rejected.
    pub(super) fn at_most_one(&mut self, keys: &[&'static str]) {
        let mut written = keys.iter().filter_map(|name| Some((*name, self.written(name)?)));
        let Some((first, _)) = written.next() else { return };
        for (name, place) in written.collect::<Vec<_>>() {
            if !self.findings.has_error_within(place) {
                let message = format!("both `{first}` and `{name}`: state only one of the two");
                self.findings.push(RawFinding::error(place, message));
            }
        }
    }

    /// True if one of these keys is present, or none is needed.
    pub(super) fn takes_absent_of(&mut self, keys: &[&'static str]) -> bool {
        keys.iter().any(|name| self.is_there(name)) || self.takes_absent()
    }

    /// True if a key of the current table has a value, from the table or from its layers.
    pub(super) fn is_there(&self, name: &str) -> bool {
        let layers = self.frames.last().map(|frame| frame.layers.as_slice()).unwrap_or_default();
        layers.iter().any(|layer| !layer.hidden.contains(&name) && layer.node.get(name).is_some())
    }

    pub(super) fn is_lost(&self) -> bool {
        self.frames.last().is_some_and(|frame| frame.lost)
    }

    /// Place of a key of the current table, in it or in its layers; keys from the catalogue have
    /// none.
    pub(super) fn written(&self, name: &str) -> Option<Place> {
        let seen = |layer: &&Layer<'_>| layer.entry.is_none() && !layer.hidden.contains(&name);
        let mut layers = self.frames.last()?.layers.iter().filter(seen);
        layers.find_map(|layer| Some(layer.node.get(name)?.node.place))
    }
}
