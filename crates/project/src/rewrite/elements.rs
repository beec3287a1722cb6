//! Writing of the elements of a controller or a prefilter into their file: those that remain keep
//! their text and their comments.

mod array;
mod section;

use std::ops::Range;

use super::with_law;
use crate::text::Findings;
use crate::tree::{Entry, TreeNode, Value as TreeValue, read as read_tree};
use crate::{DeclaredElement, Refusal, Transfer};

/// Error for elements that cannot be written.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RewriteError {
    /// File that cannot be read.
    #[error("{0}")]
    Refused(Refusal),
    /// Elements in tables with others between them.
    #[error("the elements of [{table}] are separated by other tables: bring them together first")]
    Scattered {
        /// Table, `controller` or `prefilter`.
        table: &'static str,
    },
}

/// Bytes of a text and their replacement.
struct Replacement {
    range: Range<usize>,
    text: String,
}

/// Element as written in a file.
struct WrittenElement<'a> {
    /// Element; `None` if it cannot be read; it is then rewritten.
    element: Option<DeclaredElement>,
    node: &'a TreeNode,
}

/// File that is being rewritten.
struct Draft<'a> {
    content: &'a str,
    /// Line ending of the file.
    newline: &'static str,
    table: &'static str,
    elements: &'a [DeclaredElement],
}

/// Bytes of a project file with these elements in `table`, which is `controller` or `prefilter`;
/// all other bytes are unchanged.
///
/// # Errors
/// [`RewriteError`]
pub fn with_elements(
    path: &str,
    bytes: &[u8],
    table: &'static str,
    elements: &[DeclaredElement],
) -> Result<Vec<u8>, RewriteError> {
    let mut findings = Findings::default();
    let Some(root) = read_tree(path, bytes, &mut findings) else {
        return Err(RewriteError::Refused(findings.report()));
    };
    let skipped = bytes.len() - findings.content(root.place.text).len();
    let content = findings.content(root.place.text).to_string();
    let newline = if content.contains("\r\n") { "\r\n" } else { "\n" };
    let draft = Draft { content: &content, newline, table, elements };
    let rewritten = draft.rewritten(&root, &mut findings)?;
    Ok([bytes.get(..skipped).unwrap_or_default(), rewritten.as_bytes()].concat())
}

impl Draft<'_> {
    fn rewritten(&self, root: &TreeNode, findings: &mut Findings) -> Result<String, RewriteError> {
        let table = root.get(self.table).map(|entry| &entry.node);
        let given = table.map(|table| Transfer::read(table, findings).as_elements()).unwrap_or_default();
        if given == self.elements {
            return Ok(self.content.to_string());
        }
        let list = table.and_then(|table| table.get("elements").map(|list| (table, list)));
        let Some((table, list)) = list else {
            let elements = [("elements".to_string(), array::fresh(self))];
            return Ok(with_law(self.content, self.table, &elements));
        };
        let mut replacements = self.in_list(table, list, findings)?;
        replacements.sort_by_key(|replacement| std::cmp::Reverse(replacement.range.start));
        let mut text = self.content.to_string();
        for Replacement { range, text: new } in replacements {
            text.replace_range(range, &new);
        }
        Ok(text)
    }

    fn in_list(
        &self,
        table: &TreeNode,
        list: &Entry,
        findings: &mut Findings,
    ) -> Result<Vec<Replacement>, RewriteError> {
        let TreeValue::List(nodes) = &list.node.value else { return Ok(vec![]) };
        // elements in z need a sample time, of any value
        let read = |node| WrittenElement { element: DeclaredElement::read(node, Some(1.0), findings), node };
        let written: Vec<WrittenElement<'_>> = nodes.iter().map(read).collect();
        let text = self.content.get(list.node.place.start..).unwrap_or_default();
        if text.starts_with("[[") {
            section::rewritten(self, table, &written)
        } else {
            let range = list.node.place.start..list.node.place.end;
            Ok(vec![Replacement { text: array::rewritten(self, &range, &written), range }])
        }
    }
}

impl WrittenElement<'_> {
    /// Text of the element, from `start`, if it equals this element or differs from it only in
    /// `enabled`: this key is changed in place, or added after the other keys.
    fn text_as(
        &self,
        element: &DeclaredElement,
        text: &str,
        start: usize,
        behind: (usize, &str),
    ) -> Option<String> {
        let own = self.element.as_ref()?;
        if own == element {
            return Some(text.to_string());
        }
        if (DeclaredElement { enabled: element.enabled, ..own.clone() }) != *element {
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

    /// End of the last of its values.
    fn last_value(&self) -> usize {
        self.node.entries().iter().map(|entry| entry.node.place.end).fold(self.node.place.start, usize::max)
    }
}

/// Matching element of the file for each element: equal ones in order, then those that differ only
/// in `enabled`.
fn matched(elements: &[DeclaredElement], written: &[WrittenElement<'_>]) -> Vec<Option<usize>> {
    let mut free: Vec<usize> = (0..written.len()).collect();
    let mut found = vec![None; elements.len()];
    for exactly in [true, false] {
        for (element, slot) in elements.iter().zip(&mut found).filter(|(_, slot)| slot.is_none()) {
            let alike = |index: &usize| {
                let other = written.get(*index).and_then(|written| written.element.as_ref());
                other.is_some_and(|other| {
                    let enabled = if exactly { other.enabled } else { element.enabled };
                    DeclaredElement { enabled, ..other.clone() } == *element
                })
            };
            if let Some(place) = free.iter().position(alike) {
                *slot = Some(free.remove(place));
            }
        }
    }
    found
}
