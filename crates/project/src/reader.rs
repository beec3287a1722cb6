//! Reading of a project from the tree of a file, with a report of all errors.

mod choice;
mod fields;
mod values;

use std::collections::BTreeMap;

use super::listing::KeyEntry;
use super::text::{Findings, Place, RawFinding};
use super::tree::{Entry, TreeNode, Value};
use super::{Origin, Provenance};
use crate::catalogue_entry::Catalogue;
use phea_quantity::MotionKind;
use phea_quantity::spelling::nearest;
use phea_table::{Key, Motions};

/// Reader of the tables of one file.
pub(crate) struct Reader<'a> {
    pub(crate) findings: &'a mut Findings,
    catalogue: &'a Catalogue,
    root: &'a TreeNode,
    frames: Vec<Frame<'a>>,
    /// Index of the text of the project itself; others are settings.
    project_text: usize,
    /// True if absent keys are allowed, as in the catalogue.
    partial: bool,
    /// True if a required value was absent.
    pub(crate) incomplete: bool,
    /// True for reading the parts of an actuator.
    pub(crate) parts: bool,
    /// Motion of the rig.
    motion: Motions,
    /// Numbers of the project that can be named, with their keys.
    pub(crate) named: BTreeMap<String, Key>,
    /// Whole numbers of the project, which have no range to vary in.
    pub(crate) counts: Vec<String>,
    /// Parameters that formulas may contain.
    pub(crate) parameters: Vec<String>,
    /// Places of the values, by path.
    pub(crate) places: BTreeMap<String, Place>,
    /// Paths of values that were rejected.
    pub(crate) refused: Vec<String>,
    /// Paths of tables whose kind is misspelt or missing, so that nothing follows from their keys.
    pub(crate) unclear: Vec<String>,
    /// Places of the tables of lists, by path.
    pub(crate) item_places: BTreeMap<String, Place>,
    pub(crate) provenance: Vec<Provenance>,
    pub(crate) catalogue_files: Vec<String>,
    /// Keys of all tables.
    all_keys: fn() -> Vec<KeyEntry>,
}

/// Table being read.
struct Frame<'a> {
    path: String,
    place: Place,
    /// The table itself, then the layers from which it inherits.
    layers: Vec<Layer<'a>>,
    /// Keys requested so far.
    requested: Vec<&'static str>,
    /// Missing required keys, with the finding for each at the end of the table: a misspelt key
    /// explains one.
    lacking: Vec<(&'static str, RawFinding)>,
    /// Choice of the variant being read, for messages.
    chosen: Option<String>,
    /// True if it names an entry that the catalogue does not have, so that keys that seem to be
    /// missing may not be.
    lost: bool,
    /// Keys of another variant under examination that count as absent, since they are already read.
    passed_over: Option<Vec<&'static str>>,
    /// Values of a table written as an array, in the order of its keys.
    in_order: Option<std::slice::Iter<'a, TreeNode>>,
}

/// Table, or a layer from which it inherits.
#[derive(Clone)]
struct Layer<'a> {
    node: &'a TreeNode,
    /// Ignored keys.
    hidden: Vec<&'static str>,
    /// Catalogue entry of the layer.
    entry: Option<&'a crate::catalogue_entry::CatalogueEntry>,
}

/// Value that was found.
#[derive(Clone, Copy)]
struct Hit<'a> {
    node: &'a TreeNode,
    entry: Option<&'a crate::catalogue_entry::CatalogueEntry>,
}

/// Message for a name that denotes several numbers of the project, or none.
fn not_one(name: &str, kind: &str, holds_several: bool) -> String {
    match holds_several {
        true => format!("`{name}` holds several numbers in this project, not one"),
        false => format!("`{name}` is not a {kind} of this project"),
    }
}

impl<'a> Reader<'a> {
    pub(crate) fn new(
        root: &'a TreeNode,
        project_text: usize,
        catalogue: &'a Catalogue,
        findings: &'a mut Findings,
    ) -> Self {
        let mut reader = Reader {
            findings,
            catalogue,
            root,
            frames: Vec::new(),
            project_text,
            partial: false,
            incomplete: false,
            parts: true,
            motion: Motions::default(),
            named: BTreeMap::new(),
            counts: Vec::new(),
            parameters: Vec::new(),
            places: BTreeMap::new(),
            item_places: BTreeMap::new(),
            refused: Vec::new(),
            unclear: Vec::new(),
            provenance: Vec::new(),
            catalogue_files: Vec::new(),
            all_keys: Vec::new,
        };
        reader.open(String::new(), root.place, vec![Layer { node: root, hidden: Vec::new(), entry: None }]);
        reader
    }

    /// Reader that names the correct table of a misplaced key, from the keys of all tables.
    pub(crate) fn knowing(self, all_keys: fn() -> Vec<KeyEntry>) -> Self {
        Reader { all_keys, ..self }
    }

    /// Motion of the rig whose keys are read.
    pub(crate) fn motion(&self) -> MotionKind {
        self.motion.rig
    }

    /// Reader that accepts absent keys.
    pub(crate) fn partial(mut self) -> Self {
        self.partial = true;
        self
    }

    fn open(&mut self, path: String, place: Place, layers: Vec<Layer<'a>>) {
        self.frames.push(Frame {
            path,
            place,
            layers,
            requested: Vec::new(),
            lacking: Vec::new(),
            chosen: None,
            lost: false,
            passed_over: None,
            in_order: None,
        });
    }

    /// Ends a table: keys that were not read are unknown. Returns the keys that were read.
    pub(crate) fn close(&mut self) -> Vec<&'static str> {
        let Some(mut frame) = self.frames.pop() else { return Vec::new() };
        let Some(own) = frame.layers.first() else { return frame.requested };
        let requested = frame.requested.clone();
        let mut unknown = own.node.entries().iter().filter(|entry| !requested.contains(&entry.key.as_str()));
        if let Some(first) = unknown.next() {
            let known = (self.all_keys)();
            for entry in std::iter::once(first).chain(unknown) {
                self.findings.push(unknown_key(entry, &known, &mut frame));
            }
        }
        frame.lacking.drain(..).for_each(|(_, found)| self.findings.push(found));
        if let Some(extra) = frame.in_order.and_then(|mut rest| rest.next()) {
            let message = format!("too many values: `{}` has {}", frame.path, frame.requested.len());
            self.findings.push(RawFinding::error(extra.place, message));
        }
        frame.requested
    }

    /// Ends a table whose unknown keys are reported in the table around it. Returns the keys that
    /// were read.
    fn leave(&mut self) -> Vec<&'static str> {
        let Some(frame) = self.frames.pop() else { return Vec::new() };
        frame.lacking.into_iter().for_each(|(name, found)| self.lack(name, found));
        frame.requested
    }

    /// Place of the beginning of the file.
    pub(crate) fn root_place(&self) -> Place {
        Place { text: self.project_text, start: 0, end: 0 }
    }

    /// Place of the end of the project file, where another table would be written.
    pub(crate) fn end_place(&self) -> Place {
        let end = self.findings.content(self.project_text).len();
        Place { text: self.project_text, start: end, end }
    }

    /// Top-level key, whether read or not.
    pub(crate) fn root_entry(&self, key: &str) -> Option<&'a Entry> {
        self.root.get(key)
    }

    /// Marks a key of the current table as known.
    pub(crate) fn know(&mut self, key: &'static str) {
        if let Some(frame) = self.frames.last_mut() {
            frame.requested.push(key);
        }
    }

    fn path(&self, key: &str) -> String {
        match self.frames.last() {
            Some(frame) if !frame.path.is_empty() => format!("{}.{key}", frame.path),
            _ => key.to_string(),
        }
    }

    fn place(&self) -> Place {
        self.frames.last().map(|frame| frame.place).unwrap_or_default()
    }

    /// Value of a key of the current table, from the table or from its layers.
    fn find(&mut self, key: Key) -> Option<Hit<'a>> {
        let path = self.path(key.name);
        let frame = self.frames.last_mut()?;
        if frame.passed_over.as_ref().is_some_and(|keys| keys.contains(&key.name)) {
            return None;
        }
        if !frame.requested.contains(&key.name) {
            frame.requested.push(key.name);
            if let Some(values) = &mut frame.in_order {
                let node = values.next()?;
                self.places.insert(path, node.place);
                return Some(Hit { node, entry: None });
            }
        }
        let hit = frame.layers.iter().find_map(|layer| {
            let visible = !layer.hidden.contains(&key.name);
            let entry = layer.node.get(key.name).filter(|_| visible)?;
            Some(Hit { node: &entry.node, entry: layer.entry })
        })?;
        if hit.entry.is_none() {
            self.places.insert(path, hit.node.place);
        }
        Some(hit)
    }

    /// True if a number may only seem to be absent: a value or the kind of its table is unknown.
    fn seems_absent(&self, name: &str) -> bool {
        let root = |path: &str| path.split(['.', '[']).next().unwrap_or("").to_string();
        self.refused.iter().chain(&self.unclear).any(|known| root(known) == root(name))
    }

    /// Help that names a number in a table of this name, the nominal one if it exists.
    fn number_inside(&self, name: &str) -> Option<String> {
        let inside = format!("{name}.");
        let nominal = self.named.get_key_value(&format!("{name}.nominal")).map(|(path, _)| path);
        let found = nominal.or_else(|| self.named.keys().find(|path| path.starts_with(&inside)));
        found.map(|path| format!("name one of them, such as `{path}`"))
    }

    /// Correct spelling of a name with dots in it, if it was parsed as nested tables.
    fn quoted(&self, key: Key, entry: &Entry) -> Option<String> {
        let (mut name, mut node) = (entry.key.clone(), &entry.node);
        while !self.named.contains_key(&name) {
            let [inner] = node.entries() else { return None };
            name = format!("{name}.{}", inner.key);
            node = &inner.node;
        }
        Some(format!(
            "`{name}` is one name: write it in quotes, {0}.\"{name}\" (on a command line --set '{0}.\"{name}\"=...')",
            key.name
        ))
    }

    fn origin(&self, key: Key, hit: Hit<'a>) -> Origin {
        match hit.entry {
            Some(entry) => Origin::Catalogue { name: entry.name.clone(), source: entry.source_of(key.name) },
            None if hit.node.place.text == self.project_text => Origin::Project,
            None => Origin::Setting(self.findings.content(hit.node.place.text).to_string()),
        }
    }

    fn record_origin(&mut self, key: Key, origin: Origin) {
        let path = self.path(key.name);
        self.provenance.push(Provenance { path, origin });
    }

    /// True if the current table is only searched for keys of variants that were not chosen.
    fn depends_on_other_file(&self) -> bool {
        self.frames.last().is_some_and(|frame| frame.passed_over.is_some())
    }

    fn missing(&mut self, key: Key) {
        let key = key.in_motion(self.motion);
        if self.takes_absent() {
            return;
        }
        let needs = self.frames.last().and_then(|frame| frame.chosen.as_ref());
        let needs = needs.map_or(String::new(), |chosen| format!(": {chosen} needs it"));
        let message = format!("missing `{}`{}{needs}", key.name, self.of_table());
        let mut found = RawFinding::error(self.place(), message).consequence().help(key.doc);
        if !std::ptr::eq(key.dimension, &phea_quantity::RATIO) {
            found = found.expected(format!("{}, such as {}", key.dimension.name, key.dimension.examples));
        }
        self.lack(key.name, found);
    }

    /// Records the finding for a missing required key of the current table, unless a misspelt key
    /// explains it.
    pub(crate) fn lack(&mut self, name: &'static str, found: RawFinding) {
        match self.frames.last_mut() {
            Some(frame) => frame.lacking.push((name, found)),
            None => self.findings.push(found),
        }
    }

    /// True if absent keys are accepted, which is recorded: a missing catalogue entry might have
    /// had them.
    fn takes_absent(&mut self) -> bool {
        self.incomplete = true;
        self.partial || self.depends_on_other_file() || self.is_lost()
    }

    /// Current table, as in `missing ... in [line]`.
    fn of_table(&self) -> String {
        let path = self.frames.last().map_or("", |frame| frame.path.as_str());
        if path.is_empty() { String::new() } else { format!(" in [{path}]") }
    }

    fn wrong_kind(&mut self, key: Key, expected: &str, node: &TreeNode) {
        let message = format!("`{}` must be {expected}, not {}", key.name, node.kind());
        self.findings.push(RawFinding::error(node.place, message));
    }

    /// Opens the table at a hit; returns true if it is a table.
    fn enter(&mut self, key: Key, hit: Hit<'a>, path: String) -> bool {
        self.enter_as(key, hit, path, "a table")
    }

    /// Opens the table at a hit; `expected` describes the value that the key expects.
    fn enter_as(&mut self, key: Key, hit: Hit<'a>, path: String, expected: &str) -> bool {
        if !matches!(hit.node.value, Value::Table(_)) {
            self.wrong_kind(key, expected, hit.node);
            return false;
        }
        self.open(path, hit.node.place, vec![Layer { node: hit.node, hidden: Vec::new(), entry: hit.entry }]);
        true
    }
}

/// Finding for an unknown key. If it resembles a missing key, the finding states both, and the
/// missing key is not reported separately.
fn unknown_key(entry: &Entry, known: &[KeyEntry], frame: &mut Frame<'_>) -> RawFinding {
    let place = if frame.path.is_empty() { String::new() } else { format!(" in [{}]", frame.path) };
    let near = nearest(&entry.key, frame.requested.iter().copied());
    let missing = near.and_then(|name| {
        let before = frame.lacking.len();
        frame.lacking.retain(|(lacking, _)| *lacking != name);
        (frame.lacking.len() < before).then_some(name)
    });
    let homes = if missing.is_some() { Vec::new() } else { tables_with(&entry.key, &frame.path, known) };
    let missing = missing.map_or(String::new(), |name| format!(", and `{name}` is missing"));
    let message = format!("unknown key `{}`{place}{missing}", entry.key);
    let found = RawFinding::error(entry.key_place, message);
    if let Some(help) = of_one_side(&entry.key, frame) {
        return found.help(help);
    }
    let near = near.or_else(|| word_of(&entry.key, &frame.requested));
    match (near, homes.as_slice()) {
        (_, [first, ..]) if homes.len() > MOST_TABLES => {
            found.help(format!("it belongs to {} tables, such as {first}", homes.len()))
        }
        (_, [others @ .., last]) if !others.is_empty() => {
            found.help(format!("it belongs to {} or {last}", others.join(", ")))
        }
        (_, [only]) => found.help(format!("it belongs to {only}")),
        (Some(name), _) => found.help(format!("did you mean `{name}`?")),
        (None, _) if frame.requested.len() <= 16 => {
            found.help(format!("known here: {}", frame.requested.join(", ")))
        }
        (None, _) => found,
    }
}

/// Only key that has this one as a word of its name: `bulk_modulus` for `modulus`.
fn word_of(key: &str, requested: &[&'static str]) -> Option<&'static str> {
    let inside = |name: &&str| name.split('_').any(|word| word == key);
    let mut all = requested.iter().copied().filter(|name| inside(name));
    all.next().filter(|_| all.next().is_none())
}

/// Correct place of the value of one side: the table of that side, or a pair.
fn of_one_side(key: &str, frame: &Frame<'_>) -> Option<String> {
    let cut = |side: &'static str| {
        let (after, before) = (format!("_{side}"), format!("{side}_"));
        Some((side, key.strip_suffix(after.as_str()).or_else(|| key.strip_prefix(before.as_str()))?))
    };
    let (side, name) = cut("a").or_else(|| cut("b"))?;
    let has_sides = ["a", "b"].iter().all(|side| frame.requested.contains(side));
    if has_sides && name == frame.path {
        return Some(format!("line {} is [{name}.{side}]", side.to_uppercase()));
    }
    if has_sides && frame.requested.contains(&name) {
        return Some(format!("that of side {} is `{name}` in [{}.{side}]", side.to_uppercase(), frame.path));
    }
    let pair = frame.requested.iter().find(|requested| requested.strip_suffix('s') == Some(name));
    pair.map(|pair| format!("both sides are one pair: `{pair} = [A, B]`"))
}

/// Largest number of tables that a sentence names.
const MOST_TABLES: usize = 4;

/// Other tables that have a key or a table of this name.
fn tables_with(name: &str, own: &str, known: &[KeyEntry]) -> Vec<String> {
    let own: Vec<&str> = own.split('.').map(|part| part.split('[').next().unwrap_or(part)).collect();
    let own = own.join(".");
    let mut tables: Vec<String> = Vec::new();
    for entry in known {
        let parts: Vec<&str> = entry.path.split('.').collect();
        let Some(at) = parts.iter().position(|part| part.trim_end_matches("[]") == name) else { continue };
        let (table, is_list) =
            (parts[..at].join("."), parts[..at].last().is_some_and(|last| last.ends_with("[]")));
        let path = table.replace("[]", "");
        let written = match (path.as_str(), is_list) {
            ("", _) => "the top of the file".to_string(),
            (path, true) => format!("[[{path}]]"),
            (path, false) => format!("[{path}]"),
        };
        if path != own && !path.contains("NAME") && !tables.contains(&written) {
            tables.push(written);
        }
    }
    tables
}
