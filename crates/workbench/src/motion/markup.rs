//! Pages and drawings: the text between their tags.

use super::Vocabulary;
use crate::quantity::MotionKind;

/// Elements whose text is not a sentence.
const KEPT: [&str; 4] = ["code", "style", "script", "pre"];

/// The same page or drawing for a rig that turns.
pub(super) fn said(markup: &str, words: &Vocabulary) -> String {
    let markup = symbols(markup);
    let mut out = String::with_capacity(markup.len());
    let mut rest = markup.as_str();
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

/// The same with the symbols of a motor, whose subscripts have tags of their own.
fn symbols(markup: &str) -> String {
    let mut out = String::with_capacity(markup.len());
    let mut rest = markup;
    while let Some(start) = rest.find('<') {
        let (text, tagged) = rest.split_at(start);
        out.push_str(text);
        rest = match Subscript::at(&out, tagged) {
            Some(found) => found.turned(&mut out),
            None => {
                out.push('<');
                &tagged[1..]
            }
        };
    }
    out + rest
}

/// A letter and its subscript, as pages and drawings set them: `<i>F</i><sub>e</sub>`, and
/// `F<tspan dy="2.6">e</tspan>`.
struct Subscript<'t> {
    letter: char,
    /// What closes the letter.
    closes: &'static str,
    opening: &'t str,
    script: &'t str,
    closing: &'static str,
    /// What follows it.
    after: &'t str,
}

impl<'t> Subscript<'t> {
    /// The one that begins here, after what comes before.
    fn at(before: &str, tagged: &'t str) -> Option<Subscript<'t>> {
        let [closes, name] = if tagged.starts_with("<sub>") {
            ["</i>", "</sub>"]
        } else if tagged.starts_with("<tspan ") {
            [if before.ends_with("</tspan>") { "</tspan>" } else { "" }, "</tspan>"]
        } else {
            return None;
        };
        let head = before.strip_suffix(closes)?;
        let letter = head.chars().next_back().filter(|letter| letter.is_alphabetic())?;
        let head = &head[..head.len() - letter.len_utf8()];
        let is_alone = match closes {
            "</i>" => head.ends_with("<i>"),
            _ => !head.chars().next_back().is_some_and(char::is_alphanumeric),
        };
        let opening = tagged.split_at(tagged.find('>')? + 1).0;
        let (script, after) = tagged[opening.len()..].split_once(name)?;
        is_alone.then_some(Subscript { letter, closes, opening, script, closing: name, after })
    }

    /// Writes it as it is of a motor; what follows.
    fn turned(self, out: &mut String) -> &'t str {
        let Subscript { letter, closes, opening, script, closing, after } = self;
        let linear = format!("{letter}_{script}");
        let rotary = MotionKind::Rotary.formula(&linear);
        let (symbol, script) = rotary.split_once('_').unwrap_or((&rotary, ""));
        out.truncate(out.len() - closes.len() - letter.len_utf8());
        out.push_str(symbol);
        out.push_str(closes);
        if !script.is_empty() {
            out.push_str(&format!("{opening}{script}{closing}"));
            return after;
        }
        // without a subscript the drawing does not come back to the line: what follows goes on with
        // the letter
        let on_the_line = after
            .strip_prefix("<tspan dy=")
            .filter(|_| closes != "</i>")
            .and_then(|tag| tag.split_once('>')?.1.split_once("</tspan>"));
        let Some((text, further)) = on_the_line else { return after };
        out.push_str(text);
        further
    }
}
