//! Setting `--set path=value`: a value put into the tree before anything is checked.

use super::text::{Findings, Place, RawFinding};
use super::tree::{self, Entry, TreeNode, Value};

/// Largest number of parts of a path.
const MAXIMUM_PARTS: usize = 16;

/// Applies one setting. Errors of the setting, and later errors of its value, refer to the
/// setting's text.
pub(crate) fn apply(root: &mut TreeNode, setting: &str, findings: &mut Findings) {
    let text = findings.add_text(&format!("--set {setting}"), setting, 0);
    let whole = Place { text, start: 0, end: setting.len() };
    let Some(equals) = setting.find('=') else {
        let found = RawFinding::error(whole, "a setting has the form path=value");
        return findings.push(found.help("for instance --set line.length=\"2 m\""));
    };
    let parts = match parts(text, &setting[..equals]) {
        Ok(parts) => parts,
        Err(found) => return findings.push(found),
    };
    let node = value(text, equals + 1, setting, findings);
    if let Err(found) = insert(root, &parts, node) {
        findings.push(found);
    }
}

/// Part of the path and its position.
type PathPart = (String, Place);

fn parts(text: usize, path: &str) -> Result<Vec<PathPart>, RawFinding> {
    let mut parts = Vec::new();
    let mut at = 0;
    for piece in split(path) {
        let place = Place { text, start: at, end: at + piece.len() };
        at += piece.len() + 1;
        let name = piece.trim().trim_matches('"');
        if name.is_empty() {
            return Err(RawFinding::error(place, "an empty name in the path"));
        }
        parts.push((name.to_string(), place));
    }
    let whole = Place { text, start: 0, end: path.len() };
    if parts.len() > MAXIMUM_PARTS {
        return Err(RawFinding::error(whole, format!("a path of more than {MAXIMUM_PARTS} parts")));
    }
    Ok(parts)
}

/// Setting in a table.
pub(crate) struct TableSetting<'t> {
    parts: Vec<PathPart>,
    /// Value of the setting.
    pub(crate) value: &'t TreeNode,
}

impl TableSetting<'_> {
    /// Path of the setting, with parts that contain dots in quotes.
    pub(crate) fn path(&self) -> String {
        let quoted = |name: &String| if name.contains('.') { format!("\"{name}\"") } else { name.clone() };
        self.parts.iter().map(|(name, _)| quoted(name)).collect::<Vec<_>>().join(".")
    }
}

/// Settings of a table, in its order: a key is a path, as in a setting on the command line; keys
/// with dots outside quotes and tables with a heading state paths part by part, and an inline table
/// is a value.
pub(crate) fn of_table<'t>(
    table: &'t TreeNode,
    findings: &Findings,
    wrong: &mut Vec<RawFinding>,
) -> Vec<TableSetting<'t>> {
    let mut found = Vec::new();
    gather(table, &[], findings, (&mut found, wrong));
    found
}

fn gather<'t>(
    table: &'t TreeNode,
    before: &[PathPart],
    findings: &Findings,
    (found, wrong): (&mut Vec<TableSetting<'t>>, &mut Vec<RawFinding>),
) {
    for entry in table.entries() {
        let parts = match key_parts(entry, findings) {
            Ok(parts) => [before, parts.as_slice()].concat(),
            Err(finding) => {
                wrong.push(finding);
                continue;
            }
        };
        let refused = match parts.first().map(|(name, _)| name.as_str()) {
            Some("alternative") => Some("an alternative or a load case does not change alternatives"),
            Some("load_case") => Some("an alternative or a load case does not change load cases"),
            _ => None,
        };
        if let Some(refused) = refused {
            wrong.push(RawFinding::error(entry.key_place, refused));
            continue;
        }
        let Place { text, start, .. } = entry.node.place;
        let is_inline = findings.content(text).get(start..).is_some_and(|rest| rest.starts_with('{'));
        match &entry.node.value {
            Value::Table(_) if !is_inline => gather(&entry.node, &parts, findings, (found, wrong)),
            _ => found.push(TableSetting { parts, value: &entry.node }),
        }
    }
}

/// Parts of a key that is a path, each with its place inside the quotes.
fn key_parts(entry: &Entry, findings: &Findings) -> Result<Vec<PathPart>, RawFinding> {
    let Place { text, start, end } = entry.key_place;
    let written = findings.content(text).get(start..end).unwrap_or_default();
    let quotes = usize::from(written.starts_with(['"', '\'']));
    let as_written = written.get(quotes..written.len().saturating_sub(quotes)) == Some(entry.key.as_str());
    let place = |inner: Place| match as_written {
        true => Place { text, start: inner.start + start + quotes, end: inner.end + start + quotes },
        // key with escapes
        false => entry.key_place,
    };
    let moved = |(name, inner): PathPart| (name, place(inner));
    match parts(text, &entry.key) {
        Ok(parts) => Ok(parts.into_iter().map(moved).collect()),
        Err(found) => Err(found.at(entry.key_place)),
    }
}

/// Applies the settings of a table.
pub(crate) fn apply_table(root: &mut TreeNode, table: &TreeNode, findings: &mut Findings) {
    let mut wrong = Vec::new();
    for setting in of_table(table, findings, &mut wrong) {
        if let Err(found) = insert(root, &setting.parts, setting.value.clone()) {
            wrong.push(found);
        }
    }
    wrong.into_iter().for_each(|found| findings.push(found));
}

/// Splits at the dots that are not inside quotes.
fn split(path: &str) -> Vec<&str> {
    let mut inside = false;
    path.split(|c| {
        inside ^= c == '"';
        c == '.' && !inside
    })
    .collect()
}

/// Value in TOML, otherwise the bare text.
fn value(text: usize, start: usize, setting: &str, findings: &mut Findings) -> TreeNode {
    let written = &setting[start..];
    let from = start + written.len() - written.trim_start().len();
    let to = start + written.trim_end().len();
    let place = Place { text, start: from.min(to), end: to };
    let bare = || TreeNode { place, value: Value::Text(written.trim().to_string()) };
    tree::value(text, place.start..place.end, findings).unwrap_or_else(bare)
}

fn insert(table: &mut TreeNode, path: &[PathPart], value: TreeNode) -> Result<(), RawFinding> {
    let Some(((name, place), rest)) = path.split_first() else { return Ok(()) };
    let kind = table.kind();
    match &mut table.value {
        Value::Table(entries) => {
            let index = match entries.iter().position(|entry| entry.key == *name) {
                Some(index) => index,
                None => {
                    let node = TreeNode { place: *place, value: Value::Table(Vec::new()) };
                    entries.push(Entry { key: name.clone(), key_place: *place, node });
                    entries.len() - 1
                }
            };
            let Some(entry) = entries.get_mut(index) else { return Ok(()) };
            if rest.is_empty() {
                entry.key_place = *place;
                entry.node = value;
                return Ok(());
            }
            insert(&mut entry.node, rest, value)
        }
        Value::List(items) => {
            let count = items.len();
            let item = name.parse::<usize>().ok().and_then(|index| items.get_mut(index));
            let wrong = || {
                let found =
                    RawFinding::error(*place, format!("`{name}` is not an element of this list of {count}"));
                found.help("elements are counted from 0")
            };
            let item = item.ok_or_else(wrong)?;
            if rest.is_empty() {
                *item = value;
                return Ok(());
            }
            insert(item, rest, value)
        }
        _ => Err(RawFinding::error(*place, format!("nothing can be set inside {kind}"))),
    }
}
