//! Printer of a project as TOML that reads back as an equal project.

use std::collections::BTreeMap;

use super::toml_text::{bare_or_quoted, inline, list, quoted};
use phea_quantity::{self as quantity, MotionKind, Price, PricedBy};
use phea_table::CatalogueKind;
use phea_table::Formula;
use phea_table::{FormulaShape, Kinds, NamedNumber, Variants, Visitor};
use phea_table::{Key, Motions};

/// Printer of tables; the innermost is the last of `open`.
pub(crate) struct Printer {
    open: Vec<PrintedTable>,
    /// Dimension and range of numbers that are named by their path.
    named: BTreeMap<String, Key>,
    /// Motion of the rig.
    motion: Motions,
}

/// Table: its lines, then the tables in it.
#[derive(Debug, Default)]
struct PrintedTable {
    header: String,
    /// Key and value as TOML.
    lines: Vec<(String, String)>,
    inner: Vec<PrintedTable>,
}

/// Longest table written in one line.
const INLINE_WIDTH: usize = 96;

impl PrintedTable {
    /// Inline table, if it has no tables of its own.
    fn inline(&self) -> Option<String> {
        if !self.inner.is_empty() {
            return None;
        }
        Some(inline(&self.lines))
    }

    fn write(&self, out: &mut String) {
        if !self.header.is_empty() && (!self.lines.is_empty() || self.inner.is_empty()) {
            out.push_str(&format!("\n{}\n", self.header));
        }
        for (key, value) in &self.lines {
            out.push_str(&format!("{key} = {value}\n"));
        }
        for section in &self.inner {
            section.write(out);
        }
    }
}

impl Printer {
    pub(crate) fn new(named: BTreeMap<String, Key>) -> Self {
        Printer { open: vec![PrintedTable::default()], named, motion: Motions::default() }
    }

    /// Printer for keys of a rig with these motions.
    pub(crate) fn in_motions(self, motion: Motions) -> Self {
        Printer { motion, ..self }
    }

    /// Text written since the beginning as one inline table.
    pub(crate) fn finish_inline(self) -> Option<String> {
        self.open.first().and_then(PrintedTable::inline)
    }

    /// Lines of the outermost table: each key with its value, a table in it in one line.
    pub(crate) fn lines(self) -> Vec<(String, String)> {
        let PrintedTable { mut lines, inner, .. } = self.open.into_iter().next().unwrap_or_default();
        let tables = inner.iter().filter_map(|section| {
            let key = section.header.strip_prefix('[')?.strip_suffix(']')?;
            Some((key.to_string(), section.inline()?)).filter(|_| !key.starts_with('['))
        });
        lines.extend(tables);
        lines
    }

    /// Complete text.
    pub(crate) fn finish(self) -> String {
        let mut out = String::new();
        for section in &self.open {
            section.write(&mut out);
        }
        out
    }

    fn line(&mut self, key: &str, value: String) {
        if let Some(section) = self.open.last_mut() {
            section.lines.push((bare_or_quoted(key), value));
        }
    }

    /// Dotted path of the current table with one more part.
    fn path(&self, key: &str) -> String {
        let header = self.open.last().map_or("", |section| section.header.trim_matches(['[', ']']));
        if header.is_empty() { bare_or_quoted(key) } else { format!("{header}.{}", bare_or_quoted(key)) }
    }

    fn enter(&mut self, header: String) {
        self.open.push(PrintedTable { header, ..PrintedTable::default() });
    }

    fn leave(&mut self) -> PrintedTable {
        if self.open.len() > 1 { self.open.pop().unwrap_or_default() } else { PrintedTable::default() }
    }

    /// Ends a table: short ones below the first level, and those whose names have an order, are
    /// written in one line.
    fn attach(&mut self, key: &str, in_order: bool) {
        let nested = self.open.len() > 2;
        let section = self.leave();
        let fits = |text: &String| in_order || nested && text.len() <= INLINE_WIDTH;
        match section.inline().filter(fits) {
            Some(text) => self.line(key, text),
            None => {
                if let Some(outer) = self.open.last_mut() {
                    outer.inner.push(section);
                }
            }
        }
    }
}

impl Visitor for Printer {
    fn moves(&mut self, motion: Option<MotionKind>) {
        self.motion = Motions::both(motion.unwrap_or_default());
    }

    fn load_moves(&mut self, motion: Option<MotionKind>) {
        self.motion.load = motion.unwrap_or_default();
    }

    fn quantity(&mut self, key: Key, field: &mut f64) {
        let key = key.in_motion(self.motion);
        self.line(key.name, quantity::print(*field, key.dimension));
    }

    fn optional(&mut self, key: Key, field: &mut Option<f64>) {
        if let Some(value) = field {
            self.quantity(key, value);
        }
    }

    fn pair(&mut self, key: Key, field: &mut Option<[f64; 2]>) {
        let key = key.in_motion(self.motion);
        if let Some(values) = field {
            self.line(key.name, list(values.iter().map(|value| quantity::print(*value, key.dimension))));
        }
    }

    fn quantities(&mut self, key: Key, field: &mut Vec<f64>, _required: bool) {
        if !field.is_empty() {
            self.line(key.name, list(field.iter().map(|value| quantity::print_bare(*value))));
        }
    }

    fn complexes(&mut self, key: Key, field: &mut Vec<[f64; 2]>) {
        let pair = |value: &[f64; 2]| match value {
            [real, 0.0] => quantity::print_bare(*real),
            parts => list(parts.iter().map(|part| quantity::print_bare(*part))),
        };
        if !field.is_empty() {
            self.line(key.name, list(field.iter().map(pair)));
        }
    }

    fn count(&mut self, key: Key, field: &mut u32) {
        self.line(key.name, field.to_string());
    }

    fn optional_count(&mut self, key: Key, field: &mut Option<u32>) {
        if let Some(value) = field {
            self.count(key, value);
        }
    }

    fn flag(&mut self, key: Key, field: &mut bool) {
        if *field {
            self.line(key.name, field.to_string());
        }
    }

    fn switch(&mut self, key: Key, field: &mut bool) {
        if !*field {
            self.line(key.name, field.to_string());
        }
    }

    fn text(&mut self, key: Key, field: &mut Option<String>, _required: bool) {
        if let Some(text) = field {
            self.line(key.name, quoted(text));
        }
    }

    fn price(&mut self, key: Key, by: PricedBy, field: &mut Option<Price>) {
        if let Some(price) = field {
            self.line(key.name, quantity::print_price(*price, by));
        }
    }

    fn texts(&mut self, key: Key, field: &mut Vec<String>) {
        if !field.is_empty() {
            self.line(key.name, list(field.iter().map(|text| quoted(text))));
        }
    }

    fn choice<T: Copy + PartialEq>(
        &mut self,
        key: Key,
        words: &'static [(&'static str, T)],
        field: &mut T,
        _required: bool,
    ) {
        if let Some((word, _)) = words.iter().find(|(_, value)| value == field) {
            self.line(key.name, quoted(word));
        }
    }

    fn variant<T: Variants>(&mut self, key: Key, field: &mut T, _required: bool) {
        if !field.goes_without_saying() {
            self.line(key.name, quoted(field.word()));
        }
        field.visit(self);
    }

    fn formula(&mut self, key: Key, _shape: FormulaShape, field: &mut Option<Formula>, _required: bool) {
        if let Some(formula) = field {
            self.line(key.name, quoted(formula.text()));
        }
    }

    fn catalogue(&mut self, key: Key, _kind: CatalogueKind, field: &mut Option<String>) {
        self.text(key, field, false);
    }

    fn table<T: Default>(&mut self, key: Key, field: &mut Option<T>, visit: impl Fn(&mut T, &mut Self)) {
        let Some(value) = field else { return };
        self.enter(format!("[{}]", self.path(key.name)));
        visit(value, self);
        self.attach(key.name, false);
    }

    fn part<T: Default>(&mut self, field: &mut Option<T>, visit: impl Fn(&mut T, &mut Self)) {
        if let Some(value) = field {
            visit(value, self);
        }
    }

    fn way<T: Default>(
        &mut self,
        _chosen_by: &'static [&'static str],
        field: &mut Option<T>,
        visit: impl Fn(&mut T, &mut Self),
    ) {
        self.part(field, visit);
    }

    fn word_or_tables<W: Copy + PartialEq, T: Default>(
        &mut self,
        key: Key,
        (words, ..): (&'static [(&'static str, W)], &'static str, &'static str),
        word: &mut W,
        tables: &mut Vec<T>,
        visit: impl Fn(&mut T, &mut Self),
    ) {
        match tables.is_empty() {
            true => self.choice(key, words, word, false),
            false => self.tables(key, tables, visit),
        }
    }

    fn tables<T: Default>(&mut self, key: Key, field: &mut Vec<T>, visit: impl Fn(&mut T, &mut Self)) {
        let path = self.path(key.name);
        let mut sections = Vec::new();
        for value in field.iter_mut() {
            self.enter(format!("[[{path}]]"));
            visit(value, self);
            sections.push(self.leave());
        }
        let nested = self.open.len() > 1;
        let texts: Option<Vec<String>> = sections.iter().map(PrintedTable::inline).collect();
        match texts.filter(|texts| nested && !texts.is_empty()) {
            Some(texts) => self.line(key.name, list(texts.into_iter())),
            None => {
                if let Some(outer) = self.open.last_mut() {
                    outer.inner.extend(sections);
                }
            }
        }
    }

    fn one_or_more<T: Default>(&mut self, key: Key, field: &mut Vec<T>, visit: impl Fn(&mut T, &mut Self)) {
        self.tables(key, field, visit);
    }

    fn dictionary<T: Default>(
        &mut self,
        key: Key,
        name_of: fn(&T) -> &str,
        field: &mut Vec<T>,
        visit: impl Fn(&mut T, NamedNumber<'_>, &mut Self),
    ) {
        if field.is_empty() {
            return;
        }
        self.enter(format!("[{}]", self.path(key.name)));
        for value in field.iter_mut() {
            let name = name_of(value).to_string();
            let Some(number) = self.named.get(&name).copied() else { continue };
            self.enter(format!("[{}]", self.path(&name)));
            visit(value, NamedNumber { name: &name, key: number }, self);
            self.attach(&name, true);
        }
        self.attach(key.name, false);
    }

    fn numbers(&mut self, _key: Key, _of: fn(Key) -> Key, field: &mut Vec<(String, f64)>) {
        for (name, value) in field.iter() {
            self.line(name, quantity::print_bare(*value));
        }
    }

    fn overrides(&mut self, key: Key, field: &mut Vec<(String, String)>) {
        self.enter(format!("[{}]", self.path(key.name)));
        for (path, value) in field.iter() {
            self.line(path, value.clone());
        }
        self.attach(key.name, true);
    }

    fn sides<T: Default + Clone + PartialEq>(
        &mut self,
        keys: [Key; 2],
        _kinds: &'static [Kinds],
        fields: &mut [T; 2],
        visit: impl Fn(&mut T, &mut Self),
    ) {
        if fields[0] == fields[1] {
            return visit(&mut fields[0], self);
        }
        for (key, field) in keys.into_iter().zip(fields) {
            self.enter(format!("[{}]", self.path(key.name)));
            visit(field, self);
            let section = self.leave();
            if let Some(outer) = self.open.last_mut() {
                outer.inner.push(section);
            }
        }
    }
}
