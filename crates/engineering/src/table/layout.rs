//! Place of the names of the columns, and their separator.

use super::cell::{Cells, Separator};
use super::column::Sought;

/// Beginning of a table in a text.
#[derive(Clone, Copy, Debug)]
pub(super) struct TextLayout {
    pub(super) separator: Separator,
    /// First byte of the row of names.
    pub(super) header: usize,
}

/// Possible separators of values; of two that explain as much, the first.
const SEPARATORS: [Separator; 5] = [
    Separator::Sign(b';'),
    Separator::Sign(b'\t'),
    Separator::Sign(b'|'),
    Separator::Sign(b','),
    Separator::Spaces,
];

/// Number of rows in which names are searched.
const MOST_ROWS: usize = 500;
/// Number of rows below the best one in which a better one is searched.
const MOST_BELOW: usize = 20;

/// Row with the most of the requested names: the first of several, and one after a `#` only if
/// there is no other.
pub(super) fn find(content: &str, sought: &[Sought<'_>], separator: Option<Separator>) -> Option<TextLayout> {
    let separators: Vec<Separator> = separator.map_or(SEPARATORS.to_vec(), |only| vec![only]);
    let mut best: Option<([usize; 3], TextLayout)> = None;
    let mut rows_below = 0;
    for (line, start) in lines(content, 0).filter(|(line, _)| !line.trim().is_empty()).take(MOST_ROWS) {
        rows_below += 1;
        if best.is_some() && rows_below > MOST_BELOW {
            break;
        }
        let trimmed = line.trim_start();
        let open = trimmed.trim_start_matches(['#', '%']);
        let header = start + line.len() - open.len();
        // `Some` for a name, true for a name with a unit of it
        let is_name = |text: &str| sought.iter().filter_map(|one| one.is_named_in(text)).max();
        let names_of = |separator: Separator| {
            let cells: Vec<_> =
                Cells::new(content, header, separator).map(|cell| is_name(cell.text)).collect();
            (cells.len(), cells.into_iter().flatten().collect::<Vec<bool>>())
        };
        // a name and its unit may have a space between them if a sign separates the columns
        let is_signed = separators.iter().any(|separator| {
            let (cells, names) = names_of(*separator);
            *separator != Separator::Spaces && cells > 1 && !names.is_empty()
        });
        for separator in separators.iter().filter(|one| !is_signed || **one != Separator::Spaces) {
            let (_, names) = names_of(*separator);
            let whole = names.iter().filter(|is_whole| **is_whole).count();
            let rank = [whole, names.len(), usize::from(open.len() == trimmed.len())];
            if !names.is_empty() && best.is_none_or(|(least, _)| rank > least) {
                best = Some((rank, TextLayout { separator: *separator, header }));
                rows_below = 0;
            }
        }
    }
    best.map(|(_, layout)| layout)
}

/// Lines from a byte on, each with its first byte.
pub(super) fn lines(content: &str, from: usize) -> impl Iterator<Item = (&str, usize)> {
    let mut start = from;
    content.get(from..).unwrap_or_default().split_inclusive('\n').map(move |line| {
        let at = start;
        start += line.len();
        (line, at)
    })
}

/// True if a row contains more than separators, and is not a comment.
pub(super) fn is_row(line: &str, separator: Separator) -> bool {
    let nothing = |sign: char| {
        sign.is_whitespace() || matches!(separator, Separator::Sign(byte) if sign == char::from(byte))
    };
    let rest = line.trim_start_matches(nothing);
    !rest.is_empty() && !line.trim_start().starts_with('#')
}
