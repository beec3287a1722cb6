//! A rejected value is the only error: no consequences of it are reported.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::unwrap_used,
    reason = "helpers of tests may fail the test"
)]

use std::collections::BTreeMap;
use std::path::Path;

use phea_project::source::Memory;
use phea_project::{self as project, Severity};

/// Valid projects of the corpus, and the examples.
fn projects() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = Vec::new();
    for folder in ["tests/valid", "../../examples/ybitu"] {
        for file in std::fs::read_dir(root.join(folder)).unwrap() {
            let path = file.unwrap().path();
            if path.extension().is_some_and(|extension| extension == "toml") {
                found.push((path.display().to_string(), std::fs::read_to_string(&path).unwrap()));
            }
        }
    }
    found
}

#[test]
fn a_refused_number_is_the_only_error() {
    let mut wrong = Vec::new();
    let mut count = 0;
    for (name, text) in projects() {
        let source = Memory::default().with("p.toml", text);
        let Ok(loaded) = project::read(&source, "p.toml", &[], &[]) else { continue };
        for (path, (_, value)) in loaded.project.listed_numbers() {
            let path = path.replace('[', ".").replace(']', "");
            // a setting creates a separate table if a side inherits one
            let is_declared =
                |value: f64| project::read(&source, "p.toml", &[format!("{path}={value:e}")], &[]).is_ok();
            if !value.is_some_and(is_declared) {
                continue;
            }
            let setting = format!("{path}=1 nonsense");
            let Err(refusal) = project::read(&source, "p.toml", &[setting], &[]) else { continue };
            let errors: Vec<_> =
                refusal.diagnostics.iter().filter(|one| one.severity == Severity::Error).collect();
            count += 1;
            for other in errors.iter().filter(|error| !error.file.starts_with("--set")) {
                wrong.push(format!("{name}: {path}: {}:{} {}", other.file, other.line, other.message));
            }
        }
    }
    assert!(count > 500, "{count}");
    assert!(wrong.is_empty(), "{} of {count}\n{}", wrong.len(), wrong.join("\n"));
}

/// Adds the projects of a folder and of its subfolders.
fn below(folder: &Path, found: &mut Vec<(String, String)>) {
    for file in std::fs::read_dir(folder).unwrap() {
        let path = file.unwrap().path();
        if path.is_dir() {
            below(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "toml") {
            found.push((path.display().to_string(), std::fs::read_to_string(&path).unwrap()));
        }
    }
}

/// Choices of this name, each with its words.
fn choices() -> BTreeMap<String, Vec<String>> {
    let mut choices: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for entry in project::keys().iter().filter(|entry| entry.takes.starts_with("one of ")) {
        let words = entry.takes.split('"').skip(1).step_by(2).map(str::to_string);
        choices.entry(entry.key.name.to_string()).or_default().extend(words);
    }
    choices.values_mut().for_each(|words| {
        words.sort();
        words.dedup();
    });
    choices
}

/// Occurrences of `key = "word"` with a word of a choice: the name, and the position after the
/// word. Comments, and settings of alternatives and load cases, which are read later, are excluded.
fn chosen(text: &str, choices: &BTreeMap<String, Vec<String>>) -> Vec<(String, usize)> {
    let is_read = |before: &str| {
        let table = before.lines().rev().find(|line| line.starts_with('[')).unwrap_or_default();
        let is_set = table.contains("alternative") || table.contains("load_case");
        !is_set && !before.lines().next_back().is_some_and(|line| line.contains('#'))
    };
    let mut found = Vec::new();
    for (name, words) in choices {
        for written in words.iter().map(|word| format!("{name} = \"{word}\"")) {
            for (at, _) in text.match_indices(&written) {
                let is_whole = text[..at].chars().next_back().is_none_or(|c| c.is_whitespace() || c == '{');
                if is_whole && is_read(&text[..at]) {
                    found.push((name.clone(), at + written.len() - 1));
                }
            }
        }
    }
    found
}

/// Text without the `key = "word"` that ends here.
fn without(text: &str, name: &str, end: usize) -> String {
    let start = text[..end].rfind(name).unwrap();
    let rest = text[end + 1..].trim_start_matches([' ', ',']);
    format!("{}{rest}", &text[..start])
}

/// Errors of a text.
fn errors(text: &str) -> Vec<String> {
    let source = Memory::default().with("p.toml", text);
    let found = project::read(&source, "p.toml", &[], &[]).err();
    let found = found.map(|refusal| refusal.diagnostics).unwrap_or_default();
    let errors = found.into_iter().filter(|one| one.severity == Severity::Error);
    errors.map(|one| one.message).collect()
}

#[test]
fn a_misspelt_choice_is_the_only_error() {
    let choices = choices();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut projects = Vec::new();
    below(&root.join("tests/valid"), &mut projects);
    below(&root.join("../../examples"), &mut projects);
    let (mut wrong, mut seen, mut missed) = (Vec::new(), BTreeMap::<String, usize>::new(), 0);
    for (file, text) in projects.iter().filter(|(_, text)| errors(text).is_empty()) {
        for (name, end) in chosen(text, &choices) {
            let found = errors(&format!("{}x{}", &text[..end], &text[end..]));
            *seen.entry(name.clone()).or_default() += 1;
            if found.len() != 1 || !found[0].starts_with(&format!("`{name}` cannot be")) {
                let line = text[..end].lines().count();
                wrong.push(format!("{file}:{line}: {name}: {}", found.join("; ")));
            }
            let absent = errors(&without(text, &name, end));
            let is_missed = absent.iter().any(|error| error.starts_with(&format!("missing `{name}`")));
            if is_missed && absent.len() > 1 {
                let line = text[..end].lines().count();
                wrong.push(format!("{file}:{line}: {name}: {}", absent.join("; ")));
            }
            missed += usize::from(is_missed);
        }
    }
    assert!(missed > 100, "{missed}");
    let unseen: Vec<&String> = choices.keys().filter(|name| !seen.contains_key(*name)).collect();
    assert!(unseen.is_empty(), "in no project: {unseen:?}");
    assert!(wrong.is_empty(), "{} of {}\n{}", wrong.len(), seen.values().sum::<usize>(), wrong.join("\n"));
}

/// Tables that a check compares with each other, in which the default of a kind would contradict
/// the text.
#[test]
fn a_misspelt_kind_causes_no_further_error() {
    let plant = "schema = 1\n[plant]\nnumerator = \"1\"\ndenominator = \"s\"\n";
    let structure = |kind: &str| {
        format!(
            "{plant}[design]\nstructure = [{{ kind = \"{kind}\" }}, {{ kind = \"zero\" }}, {{ kind = \"zero\" }}]\n"
        )
    };
    for text in [
        structure("pole_pare"),
        format!(
            "{plant}[[specification]]\nkind = \"stepp\"\nsettling_time = \"1 s\"\nfrequencies = [2, 1]\n"
        ),
        format!("{plant}[[specification]]\nkind = \"trakcing\"\nupper = 1\nlower = 2\n"),
        format!("{plant}[[specification]]\nsettling_time = \"1 s\"\n"),
    ] {
        let found = errors(&text);
        assert_eq!(found.len(), 1, "{found:#?}\n{text}");
    }
}
