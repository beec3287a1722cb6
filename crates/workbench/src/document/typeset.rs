//! Plain-text equations such as `K_H = A_u^2 beta_e/V` set with italics, subscripts and
//! superscripts.

use maud::{Markup, html};

use crate::figure::typeset::{Level, pieces_of_equation};

/// Sets a plain-text equation for a page: `_` and `^` take the next word or a `{group}`, single
/// letters are italic.
///
/// # Example
/// ```
/// use phea_workbench::document::typeset;
/// let markup = typeset("K_H = A^2/V_{ho}").into_string();
/// assert!(markup.contains("<i>K</i><sub>H</sub>") && markup.contains("<sup>2</sup>"));
/// ```
pub fn typeset(equation: &str) -> Markup {
    html! {
        span.equation {
            @for (text, level) in pieces_of_equation(equation) {
                @match level {
                    Level::Line => { (line(&text)) }
                    Level::Subscript => { sub { (text) } }
                    Level::Superscript => { sup { (text) } }
                }
            }
        }
    }
}

/// A single letter is a quantity; a longer word is a function's name or prose and is set upright.
fn line(text: &str) -> Markup {
    let letters: Vec<char> = text.chars().collect();
    let words = letters.chunk_by(|one, next| one.is_alphabetic() && next.is_alphabetic());
    html! {
        @for word in words {
            @match word {
                [letter] if letter.is_alphabetic() => { i { (letter) } }
                _ => { (String::from_iter(word)) }
            }
        }
    }
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
    html! { @for (index, word) in sentence.split(' ').enumerate() { @if index > 0 { " " } (set(word)) } }
}

/// A word with a capital letter, for the beginning of a sentence.
pub(crate) fn capital(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or(String::new(), |first| format!("{}{}", first.to_uppercase(), letters.as_str()))
}

/// A word with the marks around it.
fn set(word: &str) -> Markup {
    let core = word.trim_end_matches([',', '.', ';', ':', ')', '°']);
    let (core, tail) = word.split_at(core.len());
    let (head, core) = core.split_at(core.len() - core.trim_start_matches('(').len());
    let is_symbol = core.split_once('_').is_some_and(|(base, _)| base.chars().count() == 1);
    html! { (head) @if is_symbol { (typeset(core)) } @else { (number(core)) } (tail) }
}

/// Sets a sentence in which text between backticks is code.
pub(super) fn coded(sentence: &str) -> Markup {
    let parts = sentence.split('`').enumerate();
    html! {
        @for (index, part) in parts {
            @if index % 2 == 1 { code { (part) } } @else { (prose(part)) }
        }
    }
}

/// `2.2e6` as 2.2·10^6; anything else unchanged.
fn number(word: &str) -> Markup {
    let parts = word.split_once('e').and_then(|(mantissa, exponent)| {
        let (_, exponent): (f64, i32) = (mantissa.parse().ok()?, exponent.parse().ok()?);
        Some((mantissa, exponent))
    });
    html! { @match parts {
        Some((mantissa, exponent)) => { (mantissa) "·10" sup { (exponent) } }
        None => { (word) }
    } }
}

/// Printed form of a unit: m3/(s.V) becomes m³/(s·V).
pub(super) fn unit(text: &str) -> String {
    text.replace("Pa^0.5", "√Pa").replace('^', "").replace('2', "²").replace('3', "³").replace('.', "·")
}
