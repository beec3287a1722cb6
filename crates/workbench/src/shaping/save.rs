//! The elements written back into the file they came from: they are replaced, and every other byte stays.

mod array;
mod section;

use std::ops::Range;

use super::{Shaped, ShapingError};
use crate::command::CommandError;
use crate::project::{self, Element, Entry, Findings, Loaded, Node, Transfer, TreeValue, read_tree};
use crate::source::{Source, SourceError};

/// The forms that `elements` takes the place of.
const OTHER_FORMS: [&str; 5] = ["numerator", "denominator", "gain", "zeros", "poles"];

/// Some bytes of a text and what takes their place.
struct Replacement {
    range: Range<usize>,
    text: String,
}

/// An element as a file has it.
struct Written<'a> {
    /// `None` where it cannot be read; it is then written anew.
    element: Option<Element>,
    node: &'a Node,
}

/// A file that is rewritten.
struct Draft<'a> {
    content: &'a str,
    /// Its end of line.
    newline: &'static str,
    table: &'static str,
    elements: &'a [Element],
}

/// The bytes of the project file with these elements; settings of the command line beside them are not written.
pub(super) fn saved(
    source: &dyn Source,
    loaded: &Loaded,
    shaped: Shaped,
    elements: &[Element],
) -> Result<Vec<u8>, CommandError> {
    let not_written = |reason: String| ShapingError::NotWritten { reason };
    let bytes = source.read(&loaded.path).map_err(|error| not_written(error.to_string()))?;
    if project::sha256(&bytes) != loaded.sha256 {
        return Err(not_written("it has changed since it was read".to_string()).into());
    }
    let table = shaped.table();
    let mut findings = Findings::default();
    let Some(root) = read_tree(&loaded.path, &bytes, &mut findings) else {
        return Err(ShapingError::Refused(findings.report()).into());
    };
    let skipped = bytes.len() - findings.content(root.place.text).len();
    let content = findings.content(root.place.text).to_string();
    let newline = if content.contains("\r\n") { "\r\n" } else { "\n" };
    let draft = Draft { content: &content, newline, table, elements };
    let rewritten = draft.rewritten(&root, &mut findings)?;
    let saved = [bytes.get(..skipped).unwrap_or_default(), rewritten.as_bytes()].concat();
    read_back(source, loaded, shaped, elements, &saved)?;
    Ok(saved)
}

/// What is to be written must say what was meant.
fn read_back(
    source: &dyn Source,
    loaded: &Loaded,
    shaped: Shaped,
    elements: &[Element],
    saved: &[u8],
) -> Result<(), CommandError> {
    if !loaded.settings.is_empty() {
        return Ok(()); // the file alone need not be a valid project
    }
    let over = Over { source, path: &loaded.path, bytes: saved };
    let again = project::read(&over, &loaded.path, &[], &[]).or_else(|report| {
        // names of the user's own catalogue are known to the command line alone
        let foreign = !loaded.catalogue_files.iter().all(|file| file.starts_with("built-in:"));
        if foreign { Ok(loaded.clone()) } else { Err(ShapingError::Refused(report)) }
    })?;
    let transfer = match shaped {
        Shaped::Controller => again.project.controller.map(|controller| controller.transfer),
        Shaped::Prefilter => again.project.prefilter.map(|prefilter| prefilter.transfer),
    };
    if transfer.map(|transfer| transfer.as_elements()).unwrap_or_default() == elements {
        Ok(())
    } else {
        Err(ShapingError::NotWritten { reason: "it would not read back as these elements".to_string() }
            .into())
    }
}

/// A source in which one file has other bytes.
struct Over<'a> {
    source: &'a dyn Source,
    path: &'a str,
    bytes: &'a [u8],
}

impl Source for Over<'_> {
    fn read(&self, path: &str) -> Result<Vec<u8>, SourceError> {
        if path == self.path { Ok(self.bytes.to_vec()) } else { self.source.read(path) }
    }

    fn list(&self, path: &str) -> Result<Option<Vec<String>>, SourceError> {
        self.source.list(path)
    }
}

impl Draft<'_> {
    fn rewritten(&self, root: &Node, findings: &mut Findings) -> Result<String, ShapingError> {
        let mut replacements = match root.get(self.table) {
            None if self.elements.is_empty() => vec![],
            None => vec![self.appended()],
            Some(entry) if Transfer::read(&entry.node, findings).as_elements() == self.elements => vec![],
            Some(entry) => match entry.node.get("elements") {
                Some(list) => self.in_list(&entry.node, list, findings)?,
                None => self.in_place_of_other_forms(&entry.node),
            },
        };
        replacements.sort_by_key(|replacement| std::cmp::Reverse(replacement.range.start));
        let mut text = self.content.to_string();
        for Replacement { range, text: new } in replacements {
            text.replace_range(range, &new);
        }
        Ok(text)
    }

    /// A table of its own at the end of the file.
    fn appended(&self) -> Replacement {
        let end = self.content.len();
        let last_line =
            if self.content.is_empty() || self.content.ends_with('\n') { "" } else { self.newline };
        let Draft { newline, table, .. } = *self;
        let array = array::fresh(self);
        Replacement {
            range: end..end,
            text: format!("{last_line}{newline}[{table}]{newline}elements = {array}{newline}"),
        }
    }

    fn in_list(
        &self,
        table: &Node,
        list: &Entry,
        findings: &mut Findings,
    ) -> Result<Vec<Replacement>, ShapingError> {
        let TreeValue::List(nodes) = &list.node.value else { return Ok(vec![]) };
        // elements in z want a sample time, whichever
        let read = |node| Written { element: Element::read(node, Some(1.0), findings), node };
        let written: Vec<Written<'_>> = nodes.iter().map(read).collect();
        let text = self.content.get(list.node.place.start..).unwrap_or_default();
        if text.starts_with("[[") {
            section::rewritten(self, table, &written)
        } else {
            let range = list.node.place.start..list.node.place.end;
            Ok(vec![Replacement { text: array::rewritten(self, &range, &written), range }])
        }
    }

    /// The first key of another form becomes `elements`; the others go.
    fn in_place_of_other_forms(&self, table: &Node) -> Vec<Replacement> {
        let mut keys: Vec<&Entry> = OTHER_FORMS.iter().filter_map(|name| table.get(name)).collect();
        keys.sort_by_key(|entry| entry.key_place);
        let Some((first, others)) = keys.split_first() else { return vec![] };
        let array = array::fresh(self);
        let mut replacements = vec![Replacement {
            range: first.key_place.start..first.node.place.end,
            text: format!("elements = {array}"),
        }];
        let inline = self.content.get(table.place.start..).is_some_and(|text| text.starts_with('{'));
        let removed = |entry: &&Entry| Replacement {
            range: if inline { after_neighbour(table, entry) } else { self.line_of(entry) },
            text: String::new(),
        };
        replacements.extend(others.iter().map(removed));
        replacements
    }

    /// A key with its value and the line that they leave empty; a comment behind them stays.
    fn line_of(&self, entry: &Entry) -> Range<usize> {
        let before = self.content.get(..entry.key_place.start).unwrap_or_default();
        let start = before.rfind('\n').map_or(0, |at| at + 1);
        let end = entry.node.place.end;
        let behind = self.content.get(end..).unwrap_or_default();
        let line = behind.split_inclusive('\n').next().unwrap_or_default();
        if line.trim().is_empty() { start..end + line.len() } else { start..end + spaces(line) }
    }
}

impl Written<'_> {
    /// Its text, from `start`, where it is this element already or becomes it by its `enabled` alone: that is changed where it is written, or
    /// comes behind the other keys.
    fn text_as(&self, element: &Element, text: &str, start: usize, behind: (usize, &str)) -> Option<String> {
        let own = self.element.as_ref()?;
        if own == element {
            return Some(text.to_string());
        }
        if (Element { enabled: element.enabled, ..own.clone() }) != *element {
            return None;
        }
        let mut text = text.to_string();
        match self.node.get("enabled").map(|entry| entry.node.place) {
            Some(place) => {
                text.replace_range(place.start - start..place.end - start, &element.enabled.to_string())
            }
            None => text.insert_str(behind.0, &behind.1.replace('?', &element.enabled.to_string())),
        }
        Some(text)
    }

    /// Where the last of its values ends.
    fn last_value(&self) -> usize {
        self.node.entries().iter().map(|entry| entry.node.place.end).fold(self.node.place.start, usize::max)
    }
}

/// From the end of the value before it to the end of its own: the comma between them goes too.
fn after_neighbour(table: &Node, entry: &Entry) -> Range<usize> {
    let ends = table.entries().iter().map(|other| other.node.place.end);
    let start = ends.filter(|end| *end <= entry.key_place.start).max().unwrap_or(entry.key_place.start);
    start..entry.node.place.end
}

fn spaces(text: &str) -> usize {
    text.len() - text.trim_start_matches([' ', '\t']).len()
}

/// For each element the one of the file that it is: equal ones in order, then those that differ in `enabled` alone.
fn matched(elements: &[Element], written: &[Written<'_>]) -> Vec<Option<usize>> {
    let mut free: Vec<usize> = (0..written.len()).collect();
    let mut found = vec![None; elements.len()];
    for exactly in [true, false] {
        for (element, slot) in elements.iter().zip(&mut found).filter(|(_, slot)| slot.is_none()) {
            let alike = |index: &usize| {
                let other = written.get(*index).and_then(|written| written.element.as_ref());
                other.is_some_and(|other| {
                    let enabled = if exactly { other.enabled } else { element.enabled };
                    Element { enabled, ..other.clone() } == *element
                })
            };
            if let Some(place) = free.iter().position(alike) {
                *slot = Some(free.remove(place));
            }
        }
    }
    found
}
