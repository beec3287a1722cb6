//! Tables `[[controller.elements]]`, one for each element.

use super::{Draft, Replacement, RewriteError, WrittenElement, matched};
use crate::DeclaredElement;
use crate::tree::TreeNode;

/// Table of an element in the file.
struct ElementTable<'a> {
    /// Empty lines and comments before it.
    above: &'a str,
    /// All its lines, including the last line end.
    text: String,
}

/// Tables with their elements changed: those that remain keep their text and the comments above
/// them.
pub(super) fn rewritten(
    draft: &Draft<'_>,
    table: &TreeNode,
    written: &[WrittenElement<'_>],
) -> Result<Vec<Replacement>, RewriteError> {
    let part = |from: usize, to: usize| draft.content.get(from..to).unwrap_or_default();
    let mut sections = Vec::new();
    let mut from = None;
    for one in written {
        let start = one.node.place.start;
        let above = from.map_or("", |from| part(from, start));
        if above.lines().any(|line| !line.trim().is_empty() && !line.trim_start().starts_with('#')) {
            return Err(RewriteError::Scattered { table: draft.table });
        }
        let end = end_of_line(draft.content, one.last_value());
        let last_line = if part(start, end).ends_with('\n') { "" } else { draft.newline };
        sections.push(ElementTable { above, text: format!("{}{last_line}", part(start, end)) });
        from = Some(end);
    }
    let first = written.first().map_or(0, |one| one.node.place.start);
    let range = first..from.unwrap_or(first);
    if draft.elements.is_empty() {
        return Ok(none_left(draft, table, range));
    }
    let kept = matched(draft.elements, written);
    let mut text = String::new();
    for (element, place) in draft.elements.iter().zip(kept) {
        let own = place.and_then(|place| Some((sections.get(place)?, written.get(place)?)));
        let above = own.map_or("", |(section, _)| section.above);
        if !text.is_empty() {
            text.push_str(if above.is_empty() { draft.newline } else { above });
        }
        let kept = own.and_then(|(section, written)| {
            let switch = format!("enabled = ?{}", draft.newline);
            written.text_as(element, &section.text, written.node.place.start, (section.text.len(), &switch))
        });
        text.push_str(&kept.unwrap_or_else(|| fresh(draft, element)));
    }
    Ok(vec![Replacement { range, text }])
}

fn fresh(draft: &Draft<'_>, element: &DeclaredElement) -> String {
    let lines = element.print_lines().replace('\n', draft.newline);
    format!("[[{}.elements]]{}{lines}", draft.table, draft.newline)
}

/// Empty list, below the header of the table if it has one.
fn none_left(draft: &Draft<'_>, table: &TreeNode, range: std::ops::Range<usize>) -> Vec<Replacement> {
    let Draft { newline, table: name, .. } = *draft;
    let header = draft.content.get(table.place.start..table.place.end).unwrap_or_default();
    if header.starts_with('[') && !header.starts_with("[[") {
        let line = end_of_line(draft.content, table.place.end);
        let empty = Replacement { range: line..line, text: format!("elements = []{newline}") };
        return vec![empty, Replacement { range, text: String::new() }];
    }
    vec![Replacement { range, text: format!("[{name}]{newline}elements = []{newline}") }]
}

/// Beginning of the next line.
fn end_of_line(content: &str, at: usize) -> usize {
    content.get(at..).and_then(|rest| rest.find('\n')).map_or(content.len(), |end| at + end + 1)
}
