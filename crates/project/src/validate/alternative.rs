//! The names of alternatives, and what they may set.

use super::Check;
use crate::{AS_DECLARED, Alternative};

/// Names must differ, as names of files do: without regard to capitals.
pub(super) fn alternatives(alternatives: &[Alternative], check: &mut Check<'_, '_>) {
    for (index, one) in alternatives.iter().enumerate() {
        let path = format!("alternative[{index}].name");
        let is_same = |other: &&Alternative| other.name.eq_ignore_ascii_case(&one.name);
        if !check.declared(&path) || check.refused(&path) {
            continue;
        }
        if one.name.trim().is_empty() {
            check.error(&path, "an alternative needs a name");
        } else if one.name.eq_ignore_ascii_case(AS_DECLARED) {
            check.error(&path, format!("`{AS_DECLARED}` is the name of the project itself"));
        } else if let Some(first) = alternatives.iter().take(index).find(is_same) {
            let message = format!("there already is an alternative `{}`", first.name);
            check.error_with_help(&path, message, "give each a name of its own");
        }
    }
}
