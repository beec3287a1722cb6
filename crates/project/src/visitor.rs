//! One description of every table serves reading, printing and listing.
//!
//! Each type of the project has one `visit` function that names its keys with its fields. A
//! reader fills the fields from the file, a printer writes them, a listing collects the possible
//! keys: so each key is defined in one place.

use super::formula::Formula;
use super::key::Key;
use crate::catalogue_kind::CatalogueKind;
use phea_quantity::{MotionKind, Price, PricedBy};

/// The word of a value, in the table of a choice; empty for a value that has none.
pub fn word_of<T: PartialEq>(words: &[(&'static str, T)], value: &T) -> &'static str {
    words.iter().find(|(_, known)| known == value).map_or("", |(word, _)| word)
}

/// A choice with keys of its own for each of its variants.
pub(crate) trait Variants: Clone {
    /// True if a key of another variant is an error, and not a warning.
    const STRICT: bool = false;
    /// Every variant, before it is read.
    fn all(&self) -> Vec<Self>;
    /// The word of the choice in the file.
    fn word(&self) -> &'static str;
    /// True if its word may be omitted.
    fn goes_without_saying(&self) -> bool {
        false
    }
    /// The keys of this variant.
    fn visit<V: Visitor>(&mut self, v: &mut V);
}

/// The operations on the description of a table.
pub(crate) trait Visitor: Sized {
    /// True if keys are listed that a reader reads only together with others.
    fn names_everything(&self) -> bool {
        false
    }
    /// How the rig moves of which the keys that follow are; `None` where this is open, in a
    /// description of every key.
    fn moves(&mut self, _motion: Option<MotionKind>) {}
    /// How its load moves, where that is not as the rig does.
    fn load_moves(&mut self, _motion: Option<MotionKind>) {}
    /// A number; required unless the key has a default.
    fn quantity(&mut self, key: Key, field: &mut f64);
    /// A number that may be absent.
    fn optional(&mut self, key: Key, field: &mut Option<f64>);
    /// Two numbers in order, or absent.
    fn pair(&mut self, key: Key, field: &mut Option<[f64; 2]>);
    /// A list of numbers; required if `required`.
    fn quantities(&mut self, key: Key, field: &mut Vec<f64>, required: bool);
    /// A list of complex numbers: a number, or a pair of real and imaginary part.
    fn complexes(&mut self, key: Key, field: &mut Vec<[f64; 2]>);
    /// A whole number; required unless the key has a default.
    fn count(&mut self, key: Key, field: &mut u32);
    /// A whole number that may be absent.
    fn optional_count(&mut self, key: Key, field: &mut Option<u32>);
    /// True or false; absent, the field keeps its value.
    fn flag(&mut self, key: Key, field: &mut bool);
    /// True or false; absent, it is true.
    fn switch(&mut self, key: Key, field: &mut bool) {
        self.flag(key, field);
    }
    /// A text; required if `required`.
    fn text(&mut self, key: Key, field: &mut Option<String>, required: bool);
    /// A price that may be absent.
    fn price(&mut self, key: Key, by: PricedBy, field: &mut Option<Price>);
    /// A list of texts.
    fn texts(&mut self, key: Key, field: &mut Vec<String>);
    /// One of several words; absent, the field keeps its value unless `required`.
    fn choice<T: Copy + PartialEq>(
        &mut self,
        key: Key,
        words: &'static [(&'static str, T)],
        field: &mut T,
        required: bool,
    );
    /// A word that chooses a variant, whose own keys follow in the present table; those of the
    /// other variants have no effect. Absent, the field keeps its variant unless `required`.
    fn variant<T: Variants>(&mut self, key: Key, field: &mut T, required: bool);
    /// A formula; required if `required`.
    fn formula(&mut self, key: Key, shape: FormulaShape, field: &mut Option<Formula>, required: bool);
    /// The name of a catalogue entry, whose values apply where the table states none.
    fn catalogue(&mut self, key: Key, kind: CatalogueKind, field: &mut Option<String>);
    /// A table that may be absent.
    fn table<T: Default>(&mut self, key: Key, field: &mut Option<T>, visit: impl Fn(&mut T, &mut Self));
    /// A required table.
    fn needed_table<T: Default>(&mut self, key: Key, field: &mut T, visit: impl Fn(&mut T, &mut Self)) {
        let mut value = Some(std::mem::take(field));
        self.table(key, &mut value, visit);
        *field = value.unwrap_or_default();
    }
    /// A table whose absence means its default.
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
    /// Keys of the present table that belong to a part which may be absent as a whole.
    fn part<T: Default>(&mut self, field: &mut Option<T>, visit: impl Fn(&mut T, &mut Self));
    /// Keys of the present table that describe one thing in one way: this way is chosen if one of
    /// `chosen_by` is present, and without it the others have no effect.
    fn way<T: Default>(
        &mut self,
        chosen_by: &'static [&'static str],
        field: &mut Option<T>,
        visit: impl Fn(&mut T, &mut Self),
    );
    /// A required description is missing: a reader reports it, unless all keys of one of these ways
    /// to state it are written and were rejected.
    fn lacks(&mut self, _ways: &[&[&'static str]], _what: &str) {}
    /// Of these keys of the present table at most one may be written, and one must be if `needed`.
    fn one_of(&mut self, _keys: &'static [&'static str], _needed: bool) {}
    /// A table or, shorter, an array of its values in the order of its keys.
    fn record<T: Default>(&mut self, key: Key, field: &mut Option<T>, visit: impl Fn(&mut T, &mut Self)) {
        self.table(key, field, visit);
    }
    /// An array of tables.
    fn tables<T: Default>(&mut self, key: Key, field: &mut Vec<T>, visit: impl Fn(&mut T, &mut Self));
    /// One of several words, or an array of tables.
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
    /// One table, or an array of them.
    fn one_or_more<T: Default>(&mut self, key: Key, field: &mut Vec<T>, visit: impl Fn(&mut T, &mut Self));
    /// A table whose keys name numbers of the project; each is passed to `visit` with its
    /// properties.
    fn dictionary<T: Default>(
        &mut self,
        key: Key,
        name_of: fn(&T) -> &str,
        field: &mut Vec<T>,
        visit: impl Fn(&mut T, NamedNumber<'_>, &mut Self),
    );
    /// The present table as a list of names and numbers; `of` makes the key of an entry from the
    /// key of the number that it names.
    fn numbers(&mut self, key: Key, of: fn(Key) -> Key, field: &mut Vec<(String, f64)>);
    /// A table of settings: each a path, as `--set` takes it, and its value in TOML.
    fn overrides(&mut self, key: Key, field: &mut Vec<(String, String)>);
    /// Two tables `a` and `b` that inherit what the present table says, unless they choose a kind
    /// of their own.
    fn sides<T: Default + Clone + PartialEq>(
        &mut self,
        keys: [Key; 2],
        kinds: &'static [Kinds],
        fields: &mut [T; 2],
        visit: impl Fn(&mut T, &mut Self),
    );
    /// The form in which the key's value is written; a reader examines the file, other visitors use
    /// the form of `field`.
    fn form(&mut self, _key: Key, field: ValueForm) -> ValueForm {
        field
    }
}

/// Kinds of which one is chosen.
#[derive(Debug)]
pub(crate) struct Kinds {
    /// Keys that choose.
    pub(crate) chosen_by: &'static [&'static str],
    /// Keys that belong to one kind or another; a side that chooses its own kind inherits none of
    /// them.
    pub(crate) keys: &'static [&'static str],
}

/// A number of the project, named by the user.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NamedNumber<'a> {
    /// As written.
    pub(crate) name: &'a str,
    /// Its dimension and range.
    pub(crate) key: Key,
}

/// What a formula may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FormulaShape {
    /// A polynomial in `s` or `z`.
    Polynomial,
    /// A polynomial with parameters.
    Parametric,
    /// A ratio of polynomials.
    Ratio,
    /// Parameters and numbers without the variable.
    Coefficient,
}

/// The form of a value, where more than one is accepted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ValueForm {
    /// A number, bare or with its unit in text.
    Number,
    /// A text that is not a quantity.
    Text,
    /// A table.
    Table,
}
