//! JSON text: keys get the names of the motion, texts its words.

use crate::quantity::{MotionKind, Vocabulary};

/// The same object for a rig that turns. What hashes, versions and settings say stays.
pub(super) fn said(json: &str, words: &Vocabulary) -> String {
    let mut out = String::with_capacity(json.len());
    let mut rest = json;
    let mut key = String::new();
    while let Some(start) = rest.find('"') {
        let (before, quoted) = rest.split_at(start);
        let length = length_of(quoted);
        let (text, after) = quoted.split_at(length);
        let inside = text.trim_matches('"');
        out.push_str(before);
        if after.trim_start().starts_with(':') {
            key = inside.to_string();
            out.push_str(&format!("\"{}\"", MotionKind::Rotary.name(inside)));
        } else if is_quantity(&key) {
            out.push_str(&format!("\"{}\"", MotionKind::Rotary.name(inside)));
        } else if key == "symbol" {
            out.push_str(&format!("\"{}\"", MotionKind::Rotary.formula(inside)));
        } else if is_kept(&key) {
            out.push_str(text);
        } else {
            out.push_str(&format!("\"{}\"", words.of(inside)));
        }
        rest = after;
    }
    out.push_str(rest);
    out
}

/// Bytes of a text in quotes.
fn length_of(quoted: &str) -> usize {
    let mut escaped = false;
    for (at, letter) in quoted.char_indices().skip(1) {
        match letter {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            '"' => return at + 1,
            _ => {}
        }
    }
    quoted.len()
}

/// Keys whose text is the name of a quantity.
fn is_quantity(key: &str) -> bool {
    ["metric", "signal", "column", "quantity"].contains(&key)
}

/// Keys whose text is not a sentence.
fn is_kept(key: &str) -> bool {
    [
        "version",
        "command",
        "title",
        "project_sha256",
        "settings",
        "catalogue_files",
        "verdict",
        "status",
        "kind",
        "hose",
        "file",
        "cause",
    ]
    .contains(&key)
}
