//! Array `elements = [{ ... }, { ... }]`.

use std::ops::Range;

use super::{Draft, WrittenElement, matched};
use crate::DeclaredElement;

/// Element in an array, with the comments that belong to it.
#[derive(Default)]
struct ArrayElement {
    /// Comments on lines of their own above it.
    above: Vec<String>,
    text: String,
    /// The comment after it, with the space before the comment.
    behind: Option<String>,
}

/// Width of the longest array that is written on one line.
const LINE_WIDTH: usize = 90;

/// Array of new elements only.
pub(super) fn fresh(draft: &Draft<'_>) -> String {
    let rows = draft
        .elements
        .iter()
        .map(|element| ArrayElement { text: element.print(), ..ArrayElement::default() });
    array(rows.collect(), vec![], false, draft.newline)
}

/// Array with its elements changed: those that remain keep their text and their comments.
pub(super) fn rewritten(draft: &Draft<'_>, range: &Range<usize>, written: &[WrittenElement<'_>]) -> String {
    let part = |from: usize, to: usize| draft.content.get(from..to).unwrap_or_default();
    let mut rows: Vec<Option<ArrayElement>> = Vec::new();
    let mut from = range.start + 1;
    for (index, one) in written.iter().enumerate() {
        let place = one.node.place;
        let (behind, above) = comments(part(from, place.start), index > 0);
        if let Some(Some(last)) = rows.last_mut() {
            last.behind = behind;
        }
        rows.push(Some(ArrayElement { above, text: part(place.start, place.end).to_string(), behind: None }));
        from = place.end;
    }
    let (behind, foot) = comments(part(from, range.end.saturating_sub(1)), !written.is_empty());
    if let Some(Some(last)) = rows.last_mut() {
        last.behind = behind;
    }
    let kept = matched(draft.elements, written);
    let row = |(element, place): (&DeclaredElement, &Option<usize>)| {
        let own = place.and_then(|place| rows.get_mut(place)).and_then(Option::take).unwrap_or_default();
        let kept = place.and_then(|place| written.get(place)).and_then(|one| {
            let start = one.node.place.start;
            one.text_as(element, &own.text, start, (one.last_value() - start, ", enabled = ?"))
        });
        ArrayElement { text: kept.unwrap_or_else(|| element.print()), ..own }
    };
    let rows = draft.elements.iter().zip(&kept).map(row).collect();
    array(rows, foot, part(range.start, range.end).contains('\n'), draft.newline)
}

fn array(rows: Vec<ArrayElement>, foot: Vec<String>, several_lines: bool, newline: &str) -> String {
    let line = format!("[{}]", rows.iter().map(|row| row.text.as_str()).collect::<Vec<_>>().join(", "));
    let commented = !foot.is_empty() || rows.iter().any(|row| !row.above.is_empty() || row.behind.is_some());
    if rows.is_empty() && foot.is_empty() || !commented && !several_lines && line.len() <= LINE_WIDTH {
        return line;
    }
    let mut lines = vec!["[".to_string()];
    for ArrayElement { above, text, behind } in rows {
        lines.extend(above.iter().map(|comment| format!("    {comment}")));
        lines.push(format!("    {text},{}", behind.unwrap_or_default()));
    }
    lines.extend(foot.iter().map(|comment| format!("    {comment}")));
    lines.push("]".to_string());
    lines.join(newline)
}

/// Comments between two elements: the one after the first, and those above the second.
fn comments(gap: &str, behind_another: bool) -> (Option<String>, Vec<String>) {
    let mut lines = gap.lines();
    let first = if behind_another { lines.next().and_then(comment) } else { None };
    let behind = first.map(|(space, text)| format!("{}{text}", space.replacen(',', "", 1)));
    (behind, lines.filter_map(comment).map(|(_, text)| text.to_string()).collect())
}

/// Comment of a line that otherwise contains only a comma and spaces, and the text before it.
fn comment(line: &str) -> Option<(&str, &str)> {
    line.find('#').map(|at| line.trim_end().split_at(at))
}
