//! Pages and drawings: the text between their tags.

use crate::quantity::Vocabulary;

/// Elements whose text is no sentence.
const KEPT: [&str; 4] = ["code", "style", "script", "pre"];

/// The same page or drawing for a rig that turns.
pub(super) fn said(markup: &str, words: &Vocabulary) -> String {
    let mut out = String::with_capacity(markup.len());
    let mut rest = markup;
    let mut kept: Option<&str> = None;
    while let Some(start) = rest.find('<') {
        let (text, tagged) = rest.split_at(start);
        match kept {
            Some(_) => out.push_str(text),
            None => out.push_str(&words.of(text)),
        }
        let end = tagged.find('>').map_or(tagged.len(), |end| end + 1);
        let (tag, after) = tagged.split_at(end);
        out.push_str(tag);
        let name = tag.trim_start_matches(['<', '/']).split([' ', '>', '/']).next().unwrap_or_default();
        match kept {
            None if !tag.starts_with("</") => kept = KEPT.into_iter().find(|known| *known == name),
            Some(open) if tag.starts_with("</") && open == name => kept = None,
            _ => {}
        }
        rest = after;
    }
    out.push_str(&words.of(rest));
    out
}

/// Width and height of a drawing.
pub(super) fn view_box(svg: &str) -> Option<[f64; 2]> {
    let (_, after) = svg.split_once("viewBox=\"")?;
    let (numbers, _) = after.split_once('"')?;
    let mut numbers = numbers.split_whitespace().skip(2).map(str::parse);
    Some([numbers.next()?.ok()?, numbers.next()?.ok()?])
}
