//! Plain-text equations such as `K_H = A_u^2 beta_e/V` set with italics, subscripts and superscripts.

use maud::{Markup, PreEscaped, html};

/// Sets a plain-text equation for a page: `_` and `^` take the next word or a `{group}`, single letters are italic.
///
/// # Example
/// ```
/// use phea_workbench::document::typeset;
/// let markup = typeset("K_H = A^2/V_{ho}").into_string();
/// assert!(markup.contains("<i>K</i><sub>H</sub>") && markup.contains("<sup>2</sup>"));
/// ```
pub fn typeset(equation: &str) -> Markup {
    let mut inside = String::new();
    let mut rest = equation;
    while let Some(first) = rest.chars().next() {
        let after = &rest[first.len_utf8()..];
        rest = match first {
            '_' | '^' => {
                let (script, remainder) = script(after);
                let text = escaped(script);
                let tag = if first == '_' { "sub" } else { "sup" };
                inside.push_str(&format!("<{tag}>{text}</{tag}>"));
                remainder
            }
            _ if first.is_alphabetic() => {
                let length = rest.find(|c: char| !c.is_alphabetic()).unwrap_or(rest.len());
                let (word, remainder) = rest.split_at(length);
                let word_text = escaped(word);
                // One letter is a quantity; a longer word is a function's name or prose and stays upright.
                if word.chars().count() == 1 {
                    inside.push_str(&format!("<i>{word_text}</i>"));
                } else {
                    inside.push_str(&word_text);
                }
                remainder
            }
            _ => {
                inside.push_str(&escaped(&first.to_string()));
                after
            }
        };
    }
    html! { span.equation { (PreEscaped(inside)) } }
}

/// Sets a sentence: words such as `K_H` and numbers such as `2.2e6` as in an equation, the rest
/// unchanged.
///
/// # Example
/// ```
/// use phea_workbench::document::prose;
/// let markup = prose("take K_p = 2.7e-4 V/N of `by_volume`").into_string();
/// assert!(markup.contains("<i>K</i><sub>p</sub>") && markup.contains("2.7·10<sup>-4</sup>"));
/// assert!(markup.contains("`by_volume`"));
/// ```
pub fn prose(sentence: &str) -> Markup {
    let mut inside = String::new();
    for (index, word) in sentence.split(' ').enumerate() {
        if index > 0 {
            inside.push(' ');
        }
        let core = word.trim_end_matches([',', '.', ';', ':', ')', '°']);
        let (core, tail) = word.split_at(core.len());
        let (head, core) = core.split_at(core.len() - core.trim_start_matches('(').len());
        let is_symbol = core.split_once('_').is_some_and(|(base, _)| base.chars().count() == 1);
        let set = if is_symbol {
            typeset(core).into_string()
        } else {
            number(core).unwrap_or_else(|| escaped(core))
        };
        inside.push_str(&format!("{}{set}{}", escaped(head), escaped(tail)));
    }
    html! { (PreEscaped(inside)) }
}

/// The same, with text between backticks as code.
pub(super) fn coded(sentence: &str) -> Markup {
    let parts = sentence.split('`').enumerate();
    html! {
        @for (index, part) in parts {
            @if index % 2 == 1 { code { (part) } } @else { (prose(part)) }
        }
    }
}

/// `2.2e6` as 2.2·10^6; `None` for anything else.
fn number(word: &str) -> Option<String> {
    let (mantissa, exponent) = word.split_once('e')?;
    let (_, exponent): (f64, i32) = (mantissa.parse().ok()?, exponent.parse().ok()?);
    Some(format!("{mantissa}·10<sup>{exponent}</sup>"))
}

/// A unit as it is printed: m3/(s.V) as m³/(s·V).
pub(super) fn unit(text: &str) -> String {
    text.replace("Pa^0.5", "√Pa").replace('2', "²").replace('3', "³").replace('.', "·")
}

/// The operand of `_` or `^` and what follows it.
fn script(text: &str) -> (&str, &str) {
    if let Some((group, remainder)) = text.strip_prefix('{').and_then(|grouped| grouped.split_once('}')) {
        return (group, remainder);
    }
    let signed = usize::from(text.starts_with('-'));
    let length = text[signed..].find(|c: char| !c.is_alphanumeric()).map_or(text.len(), |end| end + signed);
    text.split_at(length)
}

fn escaped(text: &str) -> String {
    html! { (text) }.into_string()
}
