//! Lists the keys of a project, and gets or sets its numbers by their path.

use std::collections::BTreeMap;

use phea_quantity::{MotionKind, Price, PricedBy};
use phea_table::CatalogueKind;
use phea_table::Formula;
use phea_table::{FormulaShape, Kinds, NamedNumber, Variants, Visitor};
use phea_table::{Key, Motions};

/// Walks a project without changing it, except for the numbers to be set.
#[derive(Default)]
pub(crate) struct Listing {
    /// True if absent tables are listed too.
    everything: bool,
    /// Motion of the rig.
    motion: Motions,
    path: String,
    /// All keys with a value of their own, by path.
    pub(crate) keys: Vec<KeyEntry>,
    /// Keys of the outermost table.
    pub(crate) outermost: Vec<&'static str>,
    /// True if keys belong to a variant or to one of several ways, which requires them if it is
    /// chosen.
    of_variant: bool,
    /// All existing numbers, by path.
    pub(crate) numbers: BTreeMap<String, (Key, f64)>,
    /// Paths of all whole numbers, stated or not.
    pub(crate) counts: Vec<String>,
    /// Numbers to set.
    assign: BTreeMap<String, f64>,
    /// Number of them that were found.
    pub(crate) assigned: usize,
}

/// Key in the documentation.
#[derive(Clone, Debug)]
pub struct KeyEntry {
    /// Dotted path; `[]` represents each element of a list, `NAME` a name chosen by the user.
    pub path: String,
    /// Properties of the key.
    pub key: Key,
    /// Accepted value: a quantity, a text, one of several words, ...
    pub takes: String,
    /// True if its absence is an error.
    pub required: bool,
}

impl Listing {
    /// Listing of every possible key.
    pub(crate) fn of_everything() -> Self {
        Listing { everything: true, ..Listing::default() }
    }

    /// Listing that sets numbers, and lists none.
    pub(crate) fn assigning(assign: BTreeMap<String, f64>) -> Self {
        Listing { assign, ..Listing::default() }
    }

    fn path_of(&self, name: &str) -> String {
        if self.path.is_empty() { name.to_string() } else { [&self.path, ".", name].concat() }
    }

    fn list(&mut self, key: Key, takes: impl Into<String>, required: bool) {
        if self.everything {
            let path = self.path_of(key.name);
            let known = self.of_variant && self.keys.iter().any(|entry| entry.path == path);
            let required = required && !self.of_variant;
            if !known {
                self.note(key);
                self.keys.push(KeyEntry { path, key, takes: takes.into(), required });
            }
        }
    }

    fn note(&mut self, key: Key) {
        if self.path.is_empty() {
            self.outermost.push(key.name);
        }
    }

    fn number(&mut self, key: Key, field: &mut f64) {
        let path = self.path_of(key.name);
        if self.assign.is_empty() {
            self.numbers.insert(path, (key.in_motion(self.motion), *field));
        } else if let Some(value) = self.assign.get(&path) {
            *field = *value;
            self.assigned += 1;
        }
    }

    fn within(&mut self, name: &str, walk: impl FnOnce(&mut Self)) {
        let outside = self.path.len();
        self.path = self.path_of(name);
        walk(self);
        self.path.truncate(outside);
    }
}

/// Keys of a variant.
pub(crate) fn keys_of<T: Variants>(variant: &T) -> Vec<&'static str> {
    keys_of_table(|listing| variant.clone().visit(listing))
}

/// Keys of a table, without those of the tables in it.
pub(crate) fn keys_of_table(visit: impl FnOnce(&mut Listing)) -> Vec<&'static str> {
    let mut listing = Listing::of_everything();
    visit(&mut listing);
    listing.outermost
}

impl Visitor for Listing {
    fn names_everything(&self) -> bool {
        self.everything
    }

    fn moves(&mut self, motion: Option<MotionKind>) {
        self.motion = Motions::both(motion.unwrap_or_default());
    }

    fn load_moves(&mut self, motion: Option<MotionKind>) {
        self.motion.load = motion.unwrap_or_default();
    }

    fn quantity(&mut self, key: Key, field: &mut f64) {
        let key = key.in_motion(self.motion);
        self.list(key, key.dimension.name, key.default.is_none());
        self.number(key, field);
    }

    fn optional(&mut self, key: Key, field: &mut Option<f64>) {
        let key = key.in_motion(self.motion);
        self.list(key, key.dimension.name, false);
        if let Some(value) = field {
            self.number(key, value);
        }
    }

    fn pair(&mut self, key: Key, _field: &mut Option<[f64; 2]>) {
        self.list(key, format!("two of {}", key.dimension.name), false);
    }

    fn quantities(&mut self, key: Key, _field: &mut Vec<f64>, required: bool) {
        self.list(key, format!("a list of {}", key.dimension.name), required);
    }

    fn complexes(&mut self, key: Key, _field: &mut Vec<[f64; 2]>) {
        self.list(key, "a list of complex numbers", false);
    }

    fn count(&mut self, key: Key, _field: &mut u32) {
        self.list(key, "a whole number", key.default.is_none());
        self.counts.push(self.path_of(key.name));
    }

    fn optional_count(&mut self, key: Key, _field: &mut Option<u32>) {
        self.list(key, "a whole number", false);
        self.counts.push(self.path_of(key.name));
    }

    fn flag(&mut self, key: Key, _field: &mut bool) {
        self.list(key, "true or false", false);
    }

    fn text(&mut self, key: Key, _field: &mut Option<String>, required: bool) {
        self.list(key, "a text", required);
    }

    fn price(&mut self, key: Key, by: PricedBy, _field: &mut Option<Price>) {
        let takes = match by {
            PricedBy::Piece => "a price, such as \"180 EUR\"",
            PricedBy::Length => "a price for a length, such as \"40 EUR/m\"",
        };
        self.list(key, takes, false);
    }

    fn texts(&mut self, key: Key, _field: &mut Vec<String>) {
        self.list(key, "a list of texts", false);
    }

    fn choice<T: Copy + PartialEq>(
        &mut self,
        key: Key,
        words: &'static [(&'static str, T)],
        _field: &mut T,
        required: bool,
    ) {
        let all: Vec<String> = words.iter().map(|(word, _)| format!("\"{word}\"")).collect();
        self.list(key, format!("one of {}", all.join(", ")), required);
    }

    fn variant<T: Variants>(&mut self, key: Key, field: &mut T, required: bool) {
        if !self.everything {
            return field.visit(self);
        }
        let all = field.all();
        let words: Vec<String> = all.iter().map(|one| format!("\"{}\"", one.word())).collect();
        self.list(key, format!("one of {}", words.join(", ")), required);
        let outside = std::mem::replace(&mut self.of_variant, true);
        for mut one in all {
            one.visit(self);
        }
        self.of_variant = outside;
    }

    fn formula(&mut self, key: Key, shape: FormulaShape, _field: &mut Option<Formula>, required: bool) {
        let takes = match shape {
            FormulaShape::Polynomial => "a polynomial in s or z, in text",
            FormulaShape::Parametric => "a polynomial in s and named parameters, in text",
            FormulaShape::Ratio => "a ratio of polynomials in s, in text",
            FormulaShape::Coefficient => "named parameters and numbers, in text",
        };
        self.list(key, takes, required);
    }

    fn catalogue(&mut self, key: Key, kind: CatalogueKind, _field: &mut Option<String>) {
        self.list(key, format!("the name of a {} of the catalogue", kind.name()), false);
    }

    fn table<T: Default>(&mut self, key: Key, field: &mut Option<T>, visit: impl Fn(&mut T, &mut Self)) {
        let mut absent = if self.everything { Some(T::default()) } else { None };
        self.note(key);
        if let Some(value) = field.as_mut().or(absent.as_mut()) {
            self.within(key.name, |listing| visit(value, listing));
        }
    }

    fn part<T: Default>(&mut self, field: &mut Option<T>, visit: impl Fn(&mut T, &mut Self)) {
        let mut absent = if self.everything { Some(T::default()) } else { None };
        if let Some(value) = field.as_mut().or(absent.as_mut()) {
            visit(value, self);
        }
    }

    fn way<T: Default>(
        &mut self,
        _chosen_by: &'static [&'static str],
        field: &mut Option<T>,
        visit: impl Fn(&mut T, &mut Self),
    ) {
        let outside = std::mem::replace(&mut self.of_variant, true);
        self.part(field, visit);
        self.of_variant = outside;
    }

    fn tables<T: Default>(&mut self, key: Key, field: &mut Vec<T>, visit: impl Fn(&mut T, &mut Self)) {
        self.note(key);
        if self.everything {
            self.within(&format!("{}[]", key.name), |listing| visit(&mut T::default(), listing));
        }
        for (index, value) in field.iter_mut().enumerate() {
            self.within(&format!("{}[{index}]", key.name), |listing| visit(value, listing));
        }
    }

    fn one_or_more<T: Default>(&mut self, key: Key, field: &mut Vec<T>, visit: impl Fn(&mut T, &mut Self)) {
        self.tables(key, field, visit);
    }

    fn dictionary<T: Default>(
        &mut self,
        key: Key,
        _name_of: fn(&T) -> &str,
        _field: &mut Vec<T>,
        visit: impl Fn(&mut T, NamedNumber<'_>, &mut Self),
    ) {
        if self.everything {
            self.within(&format!("{}.NAME", key.name), |listing| {
                visit(&mut T::default(), NamedNumber { name: "NAME", key }, listing);
            });
        }
    }

    fn numbers(&mut self, key: Key, _of: fn(Key) -> Key, _field: &mut Vec<(String, f64)>) {
        self.list(Key { name: "NAME", ..key }, "a number", false);
    }

    fn overrides(&mut self, key: Key, _field: &mut Vec<(String, String)>) {
        self.list(key, "a table of paths and values", true);
    }

    fn sides<T: Default + Clone + PartialEq>(
        &mut self,
        keys: [Key; 2],
        _kinds: &'static [Kinds],
        fields: &mut [T; 2],
        visit: impl Fn(&mut T, &mut Self),
    ) {
        if fields[0] == fields[1] {
            visit(&mut fields[0], self);
            fields[1] = fields[0].clone();
        }
        if self.everything {
            return;
        }
        for (key, field) in keys.into_iter().zip(fields) {
            self.within(key.name, |listing| visit(field, listing));
        }
    }
}
