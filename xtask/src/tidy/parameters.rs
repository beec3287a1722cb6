//! The parameters of the actuator: the numbers of those types of `crates/hydraulics` that can be
//! rejected, because they have a method `problems` or are part of a type that has one. Users type
//! these numbers and need to know their meaning.

use std::collections::BTreeSet;

use crate::repository::Repository;
use crate::rust_file::{Line, RustFile, words};

/// A field that is a number, of a type that can be rejected.
pub(super) struct Parameter<'a> {
    pub(super) path: &'a str,
    pub(super) line: usize,
    pub(super) owner: &'a str,
    pub(super) name: &'a str,
}

/// Parameters in the order of the files.
pub(super) fn parameters(repository: &Repository) -> Vec<Parameter<'_>> {
    // a key is explained by its description
    let is_equations = |path: &str| path.starts_with("crates/hydraulics/src/") && !path.ends_with("keys.rs");
    let shipped = repository.rust_files.iter().filter(|file| file.is_shipped());
    let files: Vec<&RustFile> = shipped.filter(|file| is_equations(&file.path)).collect();
    let mut definitions: Vec<Definition> = files.iter().flat_map(|file| definitions(file)).collect();
    let mut refusable: BTreeSet<&str> = files.iter().flat_map(|file| with_problems(file)).collect();
    let mut count = 0;
    while refusable.len() > count {
        count = refusable.len();
        let lines = definitions.iter().filter(|definition| refusable.contains(definition.owner));
        let parts: Vec<&str> = lines.flat_map(|definition| words(&definition.line.code)).collect();
        refusable.extend(parts);
    }
    definitions.retain(|definition| refusable.contains(definition.owner));
    definitions.iter().flat_map(numbers).collect()
}

/// The types of a file with a method `problems`.
fn with_problems(file: &RustFile) -> Vec<&str> {
    let mut owner = "";
    let mut found = Vec::new();
    for line in file.shipped() {
        if let Some(head) = line.code.strip_prefix("impl") {
            let generic = head.split_once("> ").filter(|_| head.starts_with('<'));
            owner = words(generic.map_or(head, |(_, kind)| kind)).next().unwrap_or_default();
        }
        if line.code.contains("fn problems(") {
            found.push(owner);
        }
    }
    found
}

/// A line of the definition of a type.
struct Definition<'a> {
    path: &'a str,
    owner: &'a str,
    line: &'a Line,
}

/// The lines that define the structs and enums of a file.
fn definitions(file: &RustFile) -> Vec<Definition<'_>> {
    let mut owner = None;
    let mut found = Vec::new();
    for line in file.shipped() {
        let mut head = words(&line.code).filter(|word| !["pub", "crate", "super"].contains(word));
        if matches!(head.next(), Some("struct" | "enum")) {
            owner = head.next();
        }
        found.extend(owner.map(|owner| Definition { path: &file.path, owner, line }));
        if line.code.starts_with('}') || line.code.ends_with(';') {
            owner = None;
        }
    }
    found
}

/// The fields of a line that are `f64`, a scalar of type `S`, an array or an option of them.
fn numbers<'a>(Definition { path, owner, line }: &Definition<'a>) -> Vec<Parameter<'a>> {
    let fields = line.code.match_indices(": ").map(|(at, _)| line.code.split_at(at));
    let numbers = fields.filter_map(|(before, kind)| {
        let kind = kind.replace("Option<", "").trim_start_matches([':', ' ', '[']).to_string();
        let is_number = matches!(words(&kind).next(), Some("f64" | "S")) && !kind.starts_with('(');
        let name = words(before).last().filter(|_| is_number)?;
        Some(Parameter { path, line: line.number, owner, name })
    });
    numbers.collect()
}
