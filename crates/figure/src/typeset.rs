//! Text with sub- and superscripts, and its size by the metrics of the embedded font.
//!
//! Markup is minimal so that names given by users pass unchanged:
//! - `_` after a single letter that begins a word starts a subscript of letters, digits and primes:
//!   `K_H`, `x_p`, `omega_n` is unchanged, and so is `eaton_synflex_3130_08`;
//! - `^` starts a superscript of a sign and digits: `10^-3`, `m^3`; a hyphen there is set as a
//!   minus sign;
//! - braces contain any text: `V_{A,0}`, `e^{-sT}`.

use std::sync::OnceLock;

use skrifa::MetadataProvider;
use skrifa::instance::{LocationRef, Size};

use super::SMALL_SIZE;
use super::scene::{Anchor, Baseline, Point, Rectangle, Text, point};

/// The embedded font, a subset of DejaVu Sans 2.37; its licence is in the same folder.
pub const FONT: &[u8] = include_bytes!("../fonts/DejaVuSans.ttf");

/// Font families for a browser: the embedded font if the page or the computer has it, then faces of
/// similar width.
pub(crate) const FONT_FAMILY: &str = "'DejaVu Sans',Verdana,Geneva,'Segoe UI',sans-serif";

/// Height of a capital, in font sizes.
pub(crate) const CAPITAL: f64 = 0.729;
const ASCENDER: f64 = 0.76;
const DESCENDER: f64 = 0.236;
/// Size of a sub- or superscript, in font sizes of its line.
pub(crate) const SCRIPT_SIZE: f64 = 0.74;
const RAISED: f64 = 0.36;
const LOWERED: f64 = 0.2;

/// Height of a piece of text relative to its line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// Ordinary text on the line.
    Line,
    /// Below.
    Subscript,
    /// Above.
    Superscript,
}

impl Level {
    /// Upward shift of the letters, in font sizes of the line.
    pub const fn rise(self) -> f64 {
        match self {
            Level::Line => 0.0,
            Level::Subscript => -LOWERED,
            Level::Superscript => RAISED,
        }
    }

    /// Size in font sizes of the line.
    pub const fn scale(self) -> f64 {
        match self {
            Level::Line => 1.0,
            Level::Subscript | Level::Superscript => SCRIPT_SIZE,
        }
    }
}

/// Pieces of a marked-up line.
///
/// # Example
/// ```
/// use phea_figure::typeset::{pieces, Level::*};
/// assert_eq!(pieces("K_H"), [("K".to_string(), Line), ("H".to_string(), Subscript)]);
/// assert_eq!(pieces("10^-3"), [("10".to_string(), Line), ("\u{2212}3".to_string(), Superscript)]);
/// assert_eq!(pieces("my_rig"), [("my_rig".to_string(), Line)]);
/// ```
pub fn pieces(content: &str) -> Vec<(String, Level)> {
    let mut pieces = split(content, length_in_label);
    for (text, level) in &mut pieces {
        if *level != Level::Line {
            *text = text.replace('-', "\u{2212}");
        }
    }
    pieces
}

/// Pieces of an equation, which has no names given by users: `_` and `^` take the next word with
/// its sign, or a text in parentheses, after any letter.
///
/// # Example
/// ```
/// use phea_figure::typeset::{pieces_of_equation, Level::*};
/// assert_eq!(pieces_of_equation("beta_e"), [("beta".to_string(), Line), ("e".to_string(), Subscript)]);
/// assert_eq!(pieces_of_equation("P^(1/n)"), [("P".to_string(), Line), ("(1/n)".to_string(), Superscript)]);
/// ```
pub fn pieces_of_equation(equation: &str) -> Vec<(String, Level)> {
    split(equation, |_, _, rest| {
        if rest.first() == Some(&'(') {
            return rest.iter().position(|&c| c == ')').map_or(0, |end| end + 1);
        }
        let sign = usize::from(rest.first() == Some(&'-'));
        sign + rest.iter().skip(sign).take_while(|c| c.is_alphanumeric()).count()
    })
}

/// Number of letters that `_` or `^` takes from those after it, without a brace.
type ScriptLength = fn(level: Level, before: &[char], rest: &[char]) -> usize;

fn split(content: &str, length: ScriptLength) -> Vec<(String, Level)> {
    let letters: Vec<char> = content.chars().filter(|c| !c.is_control()).collect();
    let mut result: Vec<(String, Level)> = Vec::new();
    let mut index = 0;
    while let Some(&letter) = letters.get(index) {
        if let Some((level, script, next)) = script_at(&letters, index, length) {
            result.push((script, level));
            index = next;
        } else {
            match result.last_mut() {
                Some((text, Level::Line)) => text.push(letter),
                _ => result.push((letter.to_string(), Level::Line)),
            }
            index += 1;
        }
    }
    result
}

/// Sub- or superscript that starts at `index`: its level, its text and the index at which the line
/// continues.
fn script_at(letters: &[char], index: usize, length: ScriptLength) -> Option<(Level, String, usize)> {
    let level = match letters.get(index)? {
        '_' => Level::Subscript,
        '^' => Level::Superscript,
        _ => return None,
    };
    let rest = letters.get(index + 1..)?;
    let brace = rest.iter().position(|&c| c == '}').filter(|_| rest.first() == Some(&'{'));
    let (from, to, taken) = match brace {
        Some(end) => (1, end, end + 1),
        None => {
            let length = length(level, letters.get(..index)?, rest);
            (0, length, length)
        }
    };
    let script: String = rest.get(from..to)?.iter().collect();
    (!script.is_empty()).then(|| (level, script, index + 1 + taken))
}

fn length_in_label(level: Level, before: &[char], rest: &[char]) -> usize {
    match level {
        Level::Subscript if is_symbol(before) => {
            rest.iter().take_while(|c| c.is_alphanumeric() || **c == '\'').count()
        }
        Level::Superscript => {
            let sign = usize::from(matches!(rest.first(), Some('-' | '\u{2212}' | '+')));
            let digits = rest.iter().skip(sign).take_while(|c| c.is_ascii_digit()).count();
            if digits == 0 { 0 } else { sign + digits }
        }
        _ => 0,
    }
}

/// True if exactly one letter is between the beginning of a word and the end.
fn is_symbol(before: &[char]) -> bool {
    let mut back = before.iter().rev();
    back.next().is_some_and(|c| c.is_alphabetic())
        && back.next().is_none_or(|c| !(c.is_alphanumeric() || matches!(c, '_' | '-')))
}

/// Width of a marked-up line at a font size.
pub fn width(content: &str, size: f64) -> f64 {
    let total: f64 = pieces(content)
        .iter()
        .map(|(text, level)| level.scale() * text.chars().map(advance).sum::<f64>())
        .sum();
    total * size
}

/// Line cut to fit `limit`, with an ellipsis if text is missing.
pub fn fitted(content: &str, size: f64, limit: f64) -> String {
    if width(content, size) <= limit {
        return content.to_string();
    }
    let mut kept: String = content.to_string();
    while kept.pop().is_some() {
        let candidate = format!("{}\u{2026}", kept.trim_end());
        if width(&candidate, size) <= limit {
            return candidate;
        }
    }
    String::new()
}

/// Title of an axis and its size, made to fit `limit`: down to [`SMALL_SIZE`], and then with fewer
/// words before its unit.
pub fn fitted_title(content: &str, size: f64, limit: f64) -> (String, f64) {
    // slightly less than the limit, to the last bit
    let fitting = 0.99 * size * limit / width(content, size);
    if fitting >= SMALL_SIZE {
        return (content.to_string(), size.min(fitting));
    }
    let (words, unit) = content.split_at(content.find(" (").unwrap_or(content.len()));
    let room = limit - width(unit, SMALL_SIZE);
    let title = match room > 0.0 {
        true => format!("{}{unit}", fitted(words, SMALL_SIZE, room)),
        false => fitted(content, SMALL_SIZE, limit),
    };
    (title, SMALL_SIZE)
}

/// Advance of a letter in font sizes; a letter missing in the font counts as one.
fn advance(letter: char) -> f64 {
    // by code point, up to the last of the font
    static ADVANCES: OnceLock<Vec<f64>> = OnceLock::new();
    let table = ADVANCES.get_or_init(|| {
        let Ok(font) = skrifa::FontRef::new(FONT) else { return Vec::new() };
        let metrics = font.glyph_metrics(Size::new(1.0), LocationRef::default());
        let mut table = Vec::new();
        for (code, glyph) in font.charmap().mappings() {
            let Some(advance) = metrics.advance_width(glyph) else { continue };
            let place = code as usize;
            table.resize(table.len().max(place + 1), 1.0);
            table[place] = f64::from(advance);
        }
        table
    });
    table.get(letter as usize).copied().unwrap_or(1.0)
}

/// Downward shift from the anchor point to the baseline of the letters, in view box units.
pub(crate) fn drop_to_letters(text: &Text) -> f64 {
    match text.baseline {
        Baseline::Letters => 0.0,
        Baseline::Middle => 0.5 * CAPITAL * text.size,
        Baseline::Top => CAPITAL * text.size,
    }
}

impl Text {
    /// Smallest axis-parallel rectangle that contains the drawn text.
    pub fn bounds(&self) -> Rectangle {
        let width = width(&self.content, self.size);
        let left = match self.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => -0.5 * width,
            Anchor::End => -width,
        };
        let (mut above, mut below) = (0.0_f64, 0.0_f64);
        for (_, level) in pieces(&self.content) {
            above = above.max(level.rise() + level.scale() * ASCENDER);
            below = below.max(level.scale() * DESCENDER - level.rise());
        }
        let letters = drop_to_letters(self);
        let (top, bottom) = (letters - above * self.size, letters + below * self.size);
        let angle = self.rotation_degrees.to_radians();
        let (sine, cosine) = (phea_dynamics::portable::sin(angle), phea_dynamics::portable::cos(angle));
        let turned = |x: f64, y: f64| -> Point {
            point(self.position.x + x * cosine - y * sine, self.position.y + x * sine + y * cosine)
        };
        let corners = [
            turned(left, top),
            turned(left + width, top),
            turned(left, bottom),
            turned(left + width, bottom),
        ];
        corners.iter().fold(
            Rectangle {
                left: f64::INFINITY,
                top: f64::INFINITY,
                right: f64::NEG_INFINITY,
                bottom: f64::NEG_INFINITY,
            },
            |r, p| Rectangle {
                left: r.left.min(p.x),
                top: r.top.min(p.y),
                right: r.right.max(p.x),
                bottom: r.bottom.max(p.y),
            },
        )
    }
}
