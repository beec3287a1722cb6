//! The crates below the workbench return facts: a string literal of four words is the message of an
//! error, the meaning of a key in a file `keys.rs`, or a message about the keys of a part in its
//! file `checks.rs`.

use super::Violation;
use crate::repository::Repository;
use crate::rust_file::RustFile;

/// The crates that contain no sentence. `project` states the meaning of its keys and the errors of
/// a file, `table` the errors of a formula, and `figure` draws labels.
const FOLDERS: [&str; 5] =
    ["crates/dynamics/", "crates/engineering/", "crates/hydraulics/", "crates/qft/", "crates/quantity/"];
const MESSAGE: &str = "is a sentence: return a fact, and word it in the workbench";

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let is_of_keys = |path: &str| path.ends_with("keys.rs") || path.ends_with("/checks.rs");
    let is_in = |path: &str| FOLDERS.iter().any(|folder| path.starts_with(folder));
    let is_below = |file: &&RustFile| is_in(&file.path) && !is_of_keys(&file.path);
    repository.rust_files.iter().filter(is_below).flat_map(sentences).collect()
}

fn sentences(file: &RustFile) -> Vec<Violation> {
    let (mut found, mut text, mut open) = (Vec::new(), String::new(), 0);
    for line in file.shipped() {
        if open > 0 || line.code.trim_start().starts_with("#[") {
            open += line.code.matches('[').count() as i64 - line.code.matches(']').count() as i64;
            continue;
        }
        for (place, part) in line.texts.split('\0').enumerate() {
            if place > 0 && text.split_whitespace().filter(|word| is_word(word)).count() >= 4 {
                found.push(Violation::new(&file.path, line.number, MESSAGE));
            }
            text = if place > 0 { part.to_string() } else { text + part };
        }
        text.push(' ');
    }
    found
}

fn is_word(word: &str) -> bool {
    word.contains(char::is_lowercase) && !word.contains(['"', '/', '\\']) && !word.contains(char::is_numeric)
}
