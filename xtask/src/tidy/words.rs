//! The project speaks of itself alone: nothing in it says on which desk, or from which plan, it
//! was written.

use super::Violation;
use crate::repository::Repository;

/// This file names what it forbids.
const THIS_FILE: &str = "xtask/src/tidy/words.rs";

/// Refused anywhere, also inside a longer word.
const FRAGMENTS: [&str; 11] = [
    "DESIGN.md",
    "FACTS.md",
    "STYLE.md",
    "USERS.md",
    "CONTRACT.md",
    "/work/",
    "/root/",
    "worktree",
    "session id",
    "language model",
    "Co-Authored-By",
];

/// Refused as whole words.
const WORDS: [&str; 8] = ["agent", "agents", "subagent", "Claude", "ChatGPT", "LLM", "FIXME", "XXX"];

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let ours = repository.texts(|path| path != THIS_FILE && !path.ends_with("Cargo.lock"));
    ours.flat_map(|(path, text)| check_text(path, text)).collect()
}

fn check_text(path: &str, text: &str) -> Vec<Violation> {
    let mut found = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let fragments = FRAGMENTS.iter().filter(|fragment| line.contains(**fragment));
        let words = WORDS.iter().filter(|word| has_word(line, word));
        found.extend(fragments.chain(words).map(|word| {
            Violation::new(path, index + 1, format!("`{word}`: the project speaks of itself alone"))
        }));
    }
    found
}

fn has_word(line: &str, word: &str) -> bool {
    line.split(|c: char| !c.is_alphanumeric()).any(|part| part == word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn references_to_the_workshop_are_refused() {
        for text in ["see FACTS.md section 1", "/work/main", "written by an agent.", "FIXME"] {
            assert_eq!(check_text("a.rs", text).len(), 1, "{text}");
        }
    }

    #[test]
    fn ordinary_words_pass() {
        assert!(check_text("a.rs", "a reagent, the network/work, factual, users, the design").is_empty());
    }
}
