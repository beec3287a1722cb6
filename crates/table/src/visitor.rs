//! Single description of every table for reading, printing and listing.
//!
//! Each type has one `visit` function that names its keys with its fields. A reader fills the
//! fields from the file, a printer writes them, a listing collects the possible keys, and an open
//! table fills the type over other numbers: so each key is defined in one place.

use crate::catalogue_kind::CatalogueKind;
use crate::formula::Formula;
use crate::key::Key;
use phea_quantity::{MotionKind, Price, PricedBy};

/// Number that a table holds: as a file states it, or one of another type in its place.
pub trait TableNumber: Copy + Default + PartialEq + From<f64> {}

impl<S: Copy + Default + PartialEq + From<f64>> TableNumber for S {}

/// The number, once it has been read: before, a number that must be positive is zero.
pub fn once_read<S: TableNumber>(number: S) -> Option<S> {
    (number != S::default()).then_some(number)
}

/// Word of a value, in the table of a choice; empty for a value that has none.
pub fn word_of<T: PartialEq>(words: &[(&'static str, T)], value: &T) -> &'static str {
    words.iter().find(|(_, known)| known == value).map_or("", |(word, _)| word)
}

/// Choice with keys of its own for each of its variants, whose numbers are of the type `S`.
pub trait Variants<S: TableNumber = f64>: Clone {
    /// True if a key of another variant is an error, and not a warning.
    const STRICT: bool = false;
    /// All variants, before they are read.
    fn all(&self) -> Vec<Self>;
    /// Word of the choice in the file.
    fn word(&self) -> &'static str;
    /// True if its word may be omitted.
    fn goes_without_saying(&self) -> bool {
        false
    }
    /// Visits the keys of this variant.
    fn visit<V: Visitor<S>>(&mut self, v: &mut V);
}

/// Operations on the description of a table whose numbers are of the type `S`.
pub trait Visitor<S: TableNumber = f64>: Sized {
    /// True if keys are listed that a reader reads only together with others.
    fn names_everything(&self) -> bool {
        false
    }
    /// Sets the motion of the rig for the keys that follow; `None` if it is undetermined, in a
    /// description of every key.
    fn moves(&mut self, _motion: Option<MotionKind>) {}
    /// Sets the motion of the load, if it differs from that of the rig.
    fn load_moves(&mut self, _motion: Option<MotionKind>) {}
    /// Number; required unless the key has a default.
    fn quantity(&mut self, key: Key, field: &mut S);
    /// Number whose absence means zero: zero is read as absence, so that a part of size zero is
    /// left out.
    fn unless_zero(&mut self, key: Key, field: &mut Option<S>) {
        let mut number = field.unwrap_or_default();
        self.quantity(key, &mut number);
        *field = once_read(number);
    }
    /// Number that may be absent.
    fn optional(&mut self, key: Key, field: &mut Option<S>);
    /// Two numbers in order, or absent.
    fn pair(&mut self, key: Key, field: &mut Option<[S; 2]>);
    /// List of numbers; required if `required`.
    fn quantities(&mut self, key: Key, field: &mut Vec<S>, required: bool);
    /// List of complex numbers: a number, or a pair of real and imaginary part.
    fn complexes(&mut self, key: Key, field: &mut Vec<[f64; 2]>);
    /// Whole number; required unless the key has a default.
    fn count(&mut self, key: Key, field: &mut u32);
    /// Whole number that may be absent.
    fn optional_count(&mut self, key: Key, field: &mut Option<u32>);
    /// Flag; if absent, the field keeps its value.
    fn flag(&mut self, key: Key, field: &mut bool);
    /// Flag; if absent, it is true.
    fn switch(&mut self, key: Key, field: &mut bool) {
        self.flag(key, field);
    }
    /// Text; required if `required`.
    fn text(&mut self, key: Key, field: &mut Option<String>, required: bool);
    /// Price that may be absent.
    fn price(&mut self, key: Key, by: PricedBy, field: &mut Option<Price>);
    /// List of texts.
    fn texts(&mut self, key: Key, field: &mut Vec<String>);
    /// Choice among several words; if absent, the field keeps its value unless `required`.
    fn choice<T: Copy + PartialEq>(
        &mut self,
        key: Key,
        words: &'static [(&'static str, T)],
        field: &mut T,
        required: bool,
    );
    /// Word that chooses a variant, whose own keys follow in the current table; those of the other
    /// variants have no effect. If absent, the field keeps its variant unless `required`.
    fn variant<T: Variants<S>>(&mut self, key: Key, field: &mut T, required: bool);
    /// Formula; required if `required`.
    fn formula(&mut self, key: Key, shape: FormulaShape, field: &mut Option<Formula>, required: bool);
    /// Name of a catalogue entry, whose values apply if the table states none.
    fn catalogue(&mut self, key: Key, kind: CatalogueKind, field: &mut Option<String>);
    /// Table that may be absent.
    fn table<T: Default>(&mut self, key: Key, field: &mut Option<T>, visit: impl Fn(&mut T, &mut Self));
    /// Required table.
    fn needed_table<T: Default>(&mut self, key: Key, field: &mut T, visit: impl Fn(&mut T, &mut Self)) {
        let mut value = Some(std::mem::take(field));
        self.table(key, &mut value, visit);
        *field = value.unwrap_or_default();
    }
    /// Table whose absence means its default.
    fn table_or_default<T: Default + PartialEq>(
        &mut self,
        key: Key,
        field: &mut T,
        visit: impl Fn(&mut T, &mut Self),
    ) {
        let mut value = (*field != T::default()).then(|| std::mem::take(field));
        self.table(key, &mut value, visit);
        *field = value.unwrap_or_default();
    }
    /// Keys of the current table that belong to a part which may be absent as a whole.
    fn part<T: Default>(&mut self, field: &mut Option<T>, visit: impl Fn(&mut T, &mut Self));
    /// Keys of the current table that describe one thing in one way: this way is chosen if one of
    /// `chosen_by` is present; otherwise the other keys have no effect.
    fn way<T: Default>(
        &mut self,
        chosen_by: &'static [&'static str],
        field: &mut Option<T>,
        visit: impl Fn(&mut T, &mut Self),
    );
    /// Missing required description: a reader reports it, unless all keys of one of these ways to
    /// state it are written and were rejected.
    fn lacks(&mut self, _ways: &[&[&'static str]], _what: &str) {}
    /// Alternative keys of the current table, at most one of which may be written, and one must be
    /// if `needed`.
    fn one_of(&mut self, _keys: &'static [&'static str], _needed: bool) {}
    /// Table or, shorter, an array of its values in the order of its keys.
    fn record<T: Default>(&mut self, key: Key, field: &mut Option<T>, visit: impl Fn(&mut T, &mut Self)) {
        self.table(key, field, visit);
    }
    /// Array of tables.
    fn tables<T: Default>(&mut self, key: Key, field: &mut Vec<T>, visit: impl Fn(&mut T, &mut Self));
    /// Choice of one of several words, or an array of tables.
    fn word_or_tables<W: Copy + PartialEq, T: Default>(
        &mut self,
        key: Key,
        (words, ..): (&'static [(&'static str, W)], &'static str, &'static str),
        word: &mut W,
        tables: &mut Vec<T>,
        visit: impl Fn(&mut T, &mut Self),
    ) {
        self.choice(key, words, word, false);
        self.tables(key, tables, visit);
    }
    /// Single table, or an array of them.
    fn one_or_more<T: Default>(&mut self, key: Key, field: &mut Vec<T>, visit: impl Fn(&mut T, &mut Self));
    /// Table whose keys name numbers of the project; each is passed to `visit` with its properties.
    fn dictionary<T: Default>(
        &mut self,
        key: Key,
        name_of: fn(&T) -> &str,
        field: &mut Vec<T>,
        visit: impl Fn(&mut T, NamedNumber<'_>, &mut Self),
    );
    /// Current table as a list of names and numbers; `of` makes the key of an entry from the key of
    /// the number that it names.
    fn numbers(&mut self, key: Key, of: fn(Key) -> Key, field: &mut Vec<(String, f64)>);
    /// Table of settings: each a path, as for `--set`, and its value in TOML.
    fn overrides(&mut self, key: Key, field: &mut Vec<(String, String)>);
    /// Tables `a` and `b`, which inherit from the current table, unless they choose a kind of their
    /// own.
    fn sides<T: Default + Clone + PartialEq>(
        &mut self,
        keys: [Key; 2],
        kinds: &'static [Kinds],
        fields: &mut [T; 2],
        visit: impl Fn(&mut T, &mut Self),
    );
    /// Form in which the key's value is written; a reader examines the file, other visitors use the
    /// form of `field`.
    fn form(&mut self, _key: Key, field: ValueForm) -> ValueForm {
        field
    }
}

/// Kinds of which one is chosen.
#[derive(Debug)]
pub struct Kinds {
    /// Keys that choose.
    pub chosen_by: &'static [&'static str],
    /// Keys that belong to single kinds; a side that chooses its own kind inherits none of them.
    pub keys: &'static [&'static str],
}

/// Number of the project, named by the user.
#[derive(Clone, Copy, Debug)]
pub struct NamedNumber<'a> {
    /// Name as written.
    pub name: &'a str,
    /// Dimension and range.
    pub key: Key,
}

/// Accepted shapes of a formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FormulaShape {
    /// Polynomial in `s` or `z`.
    Polynomial,
    /// Polynomial with parameters.
    Parametric,
    /// Ratio of polynomials.
    Ratio,
    /// Parameters and numbers without the variable.
    Coefficient,
}

/// Form of a value, if more than one is accepted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ValueForm {
    /// Number, bare or with its unit in text.
    Number,
    /// Text that is not a quantity.
    Text,
    /// Table.
    Table,
}
