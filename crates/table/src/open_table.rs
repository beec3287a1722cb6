//! Table whose numbers are partly open: the same table over numbers of another type.
//!
//! A table is visited twice. The first visit lists its values in the order of its keys, and with
//! each number whether it is open; the second fills a table of the other type from this list. So no
//! table states its fields again.

use crate::catalogue_kind::CatalogueKind;
use crate::formula::Formula;
use crate::key::Key;
use crate::visitor::{FormulaShape, Kinds, NamedNumber, TableNumber, ValueForm, Variants, Visitor};
use phea_quantity::{Price, PricedBy};

/// Values of a table in the order of its keys, some of its numbers open.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenTable(Vec<TableEntry>);

/// Value in a table.
#[derive(Clone, Debug, PartialEq)]
enum TableEntry {
    /// Optional value or table that is absent.
    Absent,
    /// Table that is present.
    Present,
    /// Known number.
    Known(f64),
    /// Open number, by its index among the open ones.
    Open(usize),
    /// Whole number, length of a list, or position among the words of a choice.
    Whole(usize),
    /// Flag.
    Flag(bool),
    /// Text.
    Text(String),
    /// Price.
    Price(Price),
    /// Form of the next value.
    Form(ValueForm),
}

impl OpenTable {
    /// The table with the numbers at these paths open, also those that are absent. A path that the
    /// table lacks is ignored; the number of a side precedes that of both sides.
    pub fn new<T: Clone>(
        table: &T,
        paths: &[String],
        visit: impl FnOnce(&mut T, &mut OpenTableWriter<'_>),
    ) -> OpenTable {
        let mut writer = OpenTableWriter { paths, place: Vec::new(), entries: Vec::new() };
        visit(&mut table.clone(), &mut writer);
        OpenTable(writer.entries)
    }

    /// The table over the numbers of another type; `open` are the open ones, in the order of their
    /// paths.
    pub fn over<S: TableNumber, T: Default>(
        &self,
        open: &[S],
        visit: impl FnOnce(&mut T, &mut OpenTableReader<'_, S>),
    ) -> T {
        let mut table = T::default();
        visit(&mut table, &mut OpenTableReader { entries: self.0.iter(), open });
        table
    }
}

/// Segment of a path.
#[derive(Clone, Debug)]
enum Segment {
    /// Table.
    Table(&'static str),
    /// Table in a list.
    Item(&'static str, usize),
    /// Side, whose numbers may also be named without it.
    Side(&'static str),
}

/// First visit: lists the values.
#[derive(Debug)]
pub struct OpenTableWriter<'a> {
    paths: &'a [String],
    place: Vec<Segment>,
    entries: Vec<TableEntry>,
}

impl OpenTableWriter<'_> {
    /// Index of the open number with this key in the current table; `None` if it is known.
    fn index(&self, key: Key) -> Option<usize> {
        let find = |sides: bool| {
            self.paths.iter().position(|path| self.rest(path, sides).is_some_and(|rest| rest == key.name))
        };
        let has_side = self.place.iter().any(|segment| matches!(segment, Segment::Side(_)));
        find(true).or_else(|| find(false).filter(|_| has_side))
    }

    /// Rest of a path after the current table, with its sides or without them.
    fn rest<'n>(&self, path: &'n str, sides: bool) -> Option<&'n str> {
        self.place.iter().try_fold(path, |rest, segment| match segment {
            Segment::Table(name) => rest.strip_prefix(name)?.strip_prefix('.'),
            Segment::Side(name) if sides => rest.strip_prefix(name)?.strip_prefix('.'),
            Segment::Side(_) => Some(rest),
            Segment::Item(name, index) => {
                let (place, rest) = rest.strip_prefix(name)?.strip_prefix('[')?.split_once("].")?;
                (place.parse() == Ok(*index)).then_some(rest)
            }
        })
    }

    fn number(&mut self, key: Key, value: f64) {
        self.entries.push(self.index(key).map_or(TableEntry::Known(value), TableEntry::Open));
    }

    fn present<T>(&mut self, field: &mut Option<T>, visit: impl FnOnce(&mut T, &mut Self)) {
        match field {
            None => self.entries.push(TableEntry::Absent),
            Some(field) => {
                self.entries.push(TableEntry::Present);
                visit(field, self);
            }
        }
    }

    fn within(&mut self, segment: Segment, visit: impl FnOnce(&mut Self)) {
        self.place.push(segment);
        visit(self);
        self.place.pop();
    }
}

impl Visitor for OpenTableWriter<'_> {
    fn quantity(&mut self, key: Key, field: &mut f64) {
        self.number(key, *field);
    }

    fn unless_zero(&mut self, key: Key, field: &mut Option<f64>) {
        match (self.index(key), *field) {
            (None, None) => self.entries.push(TableEntry::Absent),
            (_, number) => self.number(key, number.unwrap_or_default()),
        }
    }

    fn optional(&mut self, key: Key, field: &mut Option<f64>) {
        let mut number = field.or(self.index(key).map(|_| 0.0));
        self.present(&mut number, |number, writer| writer.number(key, *number));
    }

    fn pair(&mut self, _key: Key, field: &mut Option<[f64; 2]>) {
        self.present(field, |pair, writer| writer.entries.extend(pair.map(TableEntry::Known)));
    }

    fn quantities(&mut self, _key: Key, field: &mut Vec<f64>, _required: bool) {
        self.entries.push(TableEntry::Whole(field.len()));
        self.entries.extend(field.iter().copied().map(TableEntry::Known));
    }

    fn complexes(&mut self, _key: Key, _field: &mut Vec<[f64; 2]>) {}

    fn count(&mut self, _key: Key, field: &mut u32) {
        self.entries.push(TableEntry::Whole(*field as usize));
    }

    fn optional_count(&mut self, key: Key, field: &mut Option<u32>) {
        self.present(field, |number, writer| writer.count(key, number));
    }

    fn flag(&mut self, _key: Key, field: &mut bool) {
        self.entries.push(TableEntry::Flag(*field));
    }

    fn text(&mut self, _key: Key, field: &mut Option<String>, _required: bool) {
        self.entries.push(field.clone().map_or(TableEntry::Absent, TableEntry::Text));
    }

    fn price(&mut self, _key: Key, _by: PricedBy, field: &mut Option<Price>) {
        self.entries.push(field.map_or(TableEntry::Absent, TableEntry::Price));
    }

    fn texts(&mut self, _key: Key, _field: &mut Vec<String>) {}

    fn choice<T: Copy + PartialEq>(
        &mut self,
        _key: Key,
        words: &'static [(&'static str, T)],
        field: &mut T,
        _required: bool,
    ) {
        let chosen = words.iter().position(|(_, value)| value == field);
        self.entries.push(chosen.map_or(TableEntry::Absent, TableEntry::Whole));
    }

    fn variant<T: Variants>(&mut self, _key: Key, field: &mut T, _required: bool) {
        let chosen = field.all().iter().position(|one| one.word() == field.word());
        self.entries.push(chosen.map_or(TableEntry::Absent, TableEntry::Whole));
        field.visit(self);
    }

    fn formula(&mut self, _key: Key, _shape: FormulaShape, _field: &mut Option<Formula>, _required: bool) {}

    fn catalogue(&mut self, key: Key, _kind: CatalogueKind, field: &mut Option<String>) {
        self.text(key, field, false);
    }

    fn table<T: Default>(&mut self, key: Key, field: &mut Option<T>, visit: impl Fn(&mut T, &mut Self)) {
        self.present(field, |field, writer| {
            writer.within(Segment::Table(key.name), |writer| visit(field, writer));
        });
    }

    fn part<T: Default>(&mut self, field: &mut Option<T>, visit: impl Fn(&mut T, &mut Self)) {
        self.present(field, visit);
    }

    fn way<T: Default>(
        &mut self,
        _chosen_by: &'static [&'static str],
        field: &mut Option<T>,
        visit: impl Fn(&mut T, &mut Self),
    ) {
        self.present(field, visit);
    }

    fn tables<T: Default>(&mut self, key: Key, field: &mut Vec<T>, visit: impl Fn(&mut T, &mut Self)) {
        self.entries.push(TableEntry::Whole(field.len()));
        for (index, item) in field.iter_mut().enumerate() {
            self.within(Segment::Item(key.name, index), |writer| visit(item, writer));
        }
    }

    fn one_or_more<T: Default>(&mut self, key: Key, field: &mut Vec<T>, visit: impl Fn(&mut T, &mut Self)) {
        self.tables(key, field, visit);
    }

    fn dictionary<T: Default>(
        &mut self,
        _key: Key,
        _name_of: fn(&T) -> &str,
        _field: &mut Vec<T>,
        _visit: impl Fn(&mut T, NamedNumber<'_>, &mut Self),
    ) {
    }

    fn numbers(&mut self, _key: Key, _of: fn(Key) -> Key, _field: &mut Vec<(String, f64)>) {}

    fn overrides(&mut self, _key: Key, _field: &mut Vec<(String, String)>) {}

    fn sides<T: Default + Clone + PartialEq>(
        &mut self,
        keys: [Key; 2],
        _kinds: &'static [Kinds],
        fields: &mut [T; 2],
        visit: impl Fn(&mut T, &mut Self),
    ) {
        for (key, field) in keys.into_iter().zip(fields) {
            self.within(Segment::Side(key.name), |writer| visit(field, writer));
        }
    }

    fn form(&mut self, _key: Key, field: ValueForm) -> ValueForm {
        self.entries.push(TableEntry::Form(field));
        field
    }
}

/// Second visit: fills a table from the list.
#[derive(Debug)]
pub struct OpenTableReader<'a, S> {
    entries: std::slice::Iter<'a, TableEntry>,
    open: &'a [S],
}

impl<S: TableNumber> OpenTableReader<'_, S> {
    fn number(&mut self) -> Option<S> {
        match self.entries.next()? {
            TableEntry::Known(number) => Some(S::from(*number)),
            TableEntry::Open(index) => self.open.get(*index).copied(),
            _ => None,
        }
    }

    fn whole(&mut self) -> Option<usize> {
        match self.entries.next()? {
            TableEntry::Whole(number) => Some(*number),
            _ => None,
        }
    }

    fn if_present<T>(&mut self, read: impl FnOnce(&mut Self) -> Option<T>) -> Option<T> {
        match self.entries.next()? {
            TableEntry::Present => read(self),
            _ => None,
        }
    }

    fn filled<T: Default>(&mut self, visit: impl FnOnce(&mut T, &mut Self)) -> Option<T> {
        let mut value = T::default();
        visit(&mut value, self);
        Some(value)
    }
}

impl<S: TableNumber> Visitor<S> for OpenTableReader<'_, S> {
    fn quantity(&mut self, _key: Key, field: &mut S) {
        *field = self.number().unwrap_or_default();
    }

    fn unless_zero(&mut self, _key: Key, field: &mut Option<S>) {
        *field = self.number();
    }

    fn optional(&mut self, _key: Key, field: &mut Option<S>) {
        *field = self.if_present(Self::number);
    }

    fn pair(&mut self, _key: Key, field: &mut Option<[S; 2]>) {
        *field = self.if_present(|reader| Some([reader.number()?, reader.number()?]));
    }

    fn quantities(&mut self, _key: Key, field: &mut Vec<S>, _required: bool) {
        let length = self.whole().unwrap_or_default();
        *field = (0..length).filter_map(|_| self.number()).collect();
    }

    fn complexes(&mut self, _key: Key, _field: &mut Vec<[f64; 2]>) {}

    fn count(&mut self, _key: Key, field: &mut u32) {
        *field = self.whole().and_then(|number| u32::try_from(number).ok()).unwrap_or_default();
    }

    fn optional_count(&mut self, _key: Key, field: &mut Option<u32>) {
        *field = self.if_present(|reader| u32::try_from(reader.whole()?).ok());
    }

    fn flag(&mut self, _key: Key, field: &mut bool) {
        if let Some(TableEntry::Flag(flag)) = self.entries.next() {
            *field = *flag;
        }
    }

    fn text(&mut self, _key: Key, field: &mut Option<String>, _required: bool) {
        *field = match self.entries.next() {
            Some(TableEntry::Text(text)) => Some(text.clone()),
            _ => None,
        };
    }

    fn price(&mut self, _key: Key, _by: PricedBy, field: &mut Option<Price>) {
        *field = match self.entries.next() {
            Some(TableEntry::Price(price)) => Some(*price),
            _ => None,
        };
    }

    fn texts(&mut self, _key: Key, _field: &mut Vec<String>) {}

    fn choice<T: Copy + PartialEq>(
        &mut self,
        _key: Key,
        words: &'static [(&'static str, T)],
        field: &mut T,
        _required: bool,
    ) {
        if let Some((_, value)) = self.whole().and_then(|chosen| words.get(chosen)) {
            *field = *value;
        }
    }

    fn variant<T: Variants<S>>(&mut self, _key: Key, field: &mut T, _required: bool) {
        if let Some(chosen) = self.whole().and_then(|chosen| field.all().into_iter().nth(chosen)) {
            *field = chosen;
        }
        field.visit(self);
    }

    fn formula(&mut self, _key: Key, _shape: FormulaShape, _field: &mut Option<Formula>, _required: bool) {}

    fn catalogue(&mut self, key: Key, _kind: CatalogueKind, field: &mut Option<String>) {
        self.text(key, field, false);
    }

    fn table<T: Default>(&mut self, _key: Key, field: &mut Option<T>, visit: impl Fn(&mut T, &mut Self)) {
        self.part(field, visit);
    }

    fn part<T: Default>(&mut self, field: &mut Option<T>, visit: impl Fn(&mut T, &mut Self)) {
        *field = self.if_present(|reader| reader.filled(visit));
    }

    fn way<T: Default>(
        &mut self,
        _chosen_by: &'static [&'static str],
        field: &mut Option<T>,
        visit: impl Fn(&mut T, &mut Self),
    ) {
        self.part(field, visit);
    }

    fn tables<T: Default>(&mut self, _key: Key, field: &mut Vec<T>, visit: impl Fn(&mut T, &mut Self)) {
        let length = self.whole().unwrap_or_default();
        *field = (0..length).filter_map(|_| self.filled(&visit)).collect();
    }

    fn one_or_more<T: Default>(&mut self, key: Key, field: &mut Vec<T>, visit: impl Fn(&mut T, &mut Self)) {
        self.tables(key, field, visit);
    }

    fn dictionary<T: Default>(
        &mut self,
        _key: Key,
        _name_of: fn(&T) -> &str,
        _field: &mut Vec<T>,
        _visit: impl Fn(&mut T, NamedNumber<'_>, &mut Self),
    ) {
    }

    fn numbers(&mut self, _key: Key, _of: fn(Key) -> Key, _field: &mut Vec<(String, f64)>) {}

    fn overrides(&mut self, _key: Key, _field: &mut Vec<(String, String)>) {}

    fn sides<T: Default + Clone + PartialEq>(
        &mut self,
        _keys: [Key; 2],
        _kinds: &'static [Kinds],
        fields: &mut [T; 2],
        visit: impl Fn(&mut T, &mut Self),
    ) {
        for field in fields {
            visit(field, self);
        }
    }

    fn form(&mut self, _key: Key, field: ValueForm) -> ValueForm {
        match self.entries.next() {
            Some(TableEntry::Form(form)) => *form,
            _ => field,
        }
    }
}
