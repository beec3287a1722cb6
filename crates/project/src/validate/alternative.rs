//! Names of alternatives and of load cases.

use super::Check;
use crate::{AS_DECLARED, Alternative, Project};

/// Checks that names differ, as names of files do: without regard to capitals.
pub(super) fn alternatives(alternatives: &[Alternative], check: &mut Check<'_, '_>) {
    let names: Vec<&str> = alternatives.iter().map(|one| one.name.as_str()).collect();
    names_differ(&names, ("alternative", "an alternative"), check);
    for (index, name) in names.into_iter().enumerate() {
        if name.eq_ignore_ascii_case(AS_DECLARED) {
            let message = format!("`{AS_DECLARED}` is the name of the project itself");
            check.error(&format!("alternative[{index}].name"), message);
        }
    }
}

/// Checks the names of load cases likewise; load cases without alternatives have no effect.
pub(super) fn load_cases(project: &Project, check: &mut Check<'_, '_>) {
    let names: Vec<&str> = project.load_cases.iter().map(|one| one.name.as_str()).collect();
    names_differ(&names, ("load_case", "a load case"), check);
    if !names.is_empty() && project.alternatives.is_empty() {
        let message = "[[load_case]] has no effect, and its values are not read: there is no [[alternative]] to judge under it";
        check.warning("load_case", message);
    }
}

fn names_differ(names: &[&str], (table, words): (&str, &str), check: &mut Check<'_, '_>) {
    for (index, name) in names.iter().enumerate() {
        let path = format!("{table}[{index}].name");
        if !check.declared(&path) || check.refused(&path) {
            continue;
        }
        if name.trim().is_empty() {
            check.error(&path, format!("{words} needs a name"));
        } else if let Some(first) = names.iter().take(index).find(|other| other.eq_ignore_ascii_case(name)) {
            let message = format!("there already is {words} `{first}`");
            check.error_with_help(&path, message, "give each a name of its own");
        }
    }
}
