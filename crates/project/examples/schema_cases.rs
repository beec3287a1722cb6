//! Prints the schema of the project file, and projects with what the reader finds in each: one JSON
//! value in each line.
//!
//! After the files that are named come mutations of those that are accepted: keys removed, renamed,
//! or given another value. The sequence is fixed by its seed. `comparisons/compare_schema.py` reads
//! the lines.
#![allow(clippy::print_stdout, reason = "what it prints is what it is for")]

use phea_project::source::Memory;
use phea_project::{STARTER, Severity, read, schema};
use serde_json::{Value, json};

const MUTATIONS: usize = 4000;

/// Replacements of a value.
const VALUES: &[&str] = &[
    "1",
    "0.5",
    "-3",
    "2.0",
    "\"20 mm\"",
    "\"70 bar\"",
    "\"5 ms\"",
    "\"2 kN\"",
    "\"7 L/min\"",
    "\"0.8\"",
    "\"3 %\"",
    "\"100 rad/s\"",
    "\"40 Hz\"",
    "\"6 dB\"",
    "\"1e-5 m3\"",
    "\"10 s^-1\"",
    "\"2 (m/s)\"",
    "\"-4 V\"",
    "\"s + 1\"",
    "\"word\"",
    "true",
    "[1, 2]",
    "[\"1 mm\", \"2 mm\"]",
    "[1, [2, 3], [2, -3]]",
    "{}",
    "[{}]",
    "inf",
    "\"inf\"",
    "{ nominal = 2, minimum = 1, maximum = 3 }",
    "\"4 N/mm2\"",
    "\"3 kg/(m.s^2)\"",
    "\"lugre\"",
    "\"segments\"",
];

struct Sequence(u64);

impl Sequence {
    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % limit.max(1) as u64) as usize
    }
}

/// Findings of the reader for a text.
fn case(name: &str, text: &str) -> Value {
    let found = read(&Memory::default().with("project.toml", text), "project.toml", &[], &[]);
    let errors: Vec<String> = match &found {
        Ok(_) => Vec::new(),
        Err(report) => {
            let errors = report.diagnostics.iter().filter(|found| found.severity == Severity::Error);
            errors.map(|found| found.message.clone()).collect()
        }
    };
    json!({ "name": name, "text": text, "accepted": found.is_ok(), "errors": errors })
}

/// A text with one line changed or left out.
fn mutated(text: &str, sequence: &mut Sequence) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_string).collect();
    let stated: Vec<usize> = (0..lines.len())
        .filter(|line| lines[*line].contains('=') && !lines[*line].starts_with('#'))
        .collect();
    for _ in 0..=sequence.below(2) {
        let Some(line) = stated.get(sequence.below(stated.len())).and_then(|index| lines.get_mut(*index))
        else {
            continue;
        };
        let Some((key, _)) = line.split_once('=') else { continue };
        let value = VALUES[sequence.below(VALUES.len())];
        *line = match sequence.below(8) {
            0 => String::new(),
            1 => format!("{}s = {value}", key.trim()),
            _ => format!("{key}= {value}"),
        };
    }
    lines.join("\n")
}

fn main() {
    println!("{}", json!({ "schema": schema() }));
    let mut accepted = vec![STARTER.to_string()];
    println!("{}", case("starter.toml", STARTER));
    for path in std::env::args().skip(1) {
        let Ok(text) = std::fs::read_to_string(&path) else { continue };
        let case = case(&path, &text);
        if case["accepted"] == true {
            accepted.push(text);
        }
        println!("{case}");
    }
    let mut sequence = Sequence(0x9e37_79b9_7f4a_7c15);
    for index in 0..MUTATIONS {
        let text = mutated(&accepted[sequence.below(accepted.len())], &mut sequence);
        println!("{}", case(&format!("mutation {index}"), &text));
    }
}
