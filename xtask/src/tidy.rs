//! The rules of the project that neither the compiler nor clippy knows, each a function from the
//! repository's files to the places that break it.

mod catalogue;
mod circles;
mod citation;
mod dependencies;
mod equations;
mod examples;
mod facts;
mod golden;
mod invariants;
mod layout;
mod links;
mod notation;
mod parameters;
mod purity;
mod sizes;
#[cfg(test)]
mod tests;
mod units;
mod wrapping;

use std::fmt::Display;
use std::path::Path;

use crate::repository::Repository;

/// A place that breaks a rule, and how it breaks it.
pub(crate) struct Violation(String);

impl Violation {
    /// A violation at a line counted from 1; line 0 is the file as a whole.
    fn new(path: &str, line: usize, message: impl Display) -> Violation {
        Violation(if line == 0 { format!("{path}: {message}") } else { format!("{path}:{line}: {message}") })
    }
}

type Check = fn(&Repository) -> Vec<Violation>;

/// Every check by its name.
const CHECKS: &[(&str, Check)] = &[
    ("book", links::check_listed),
    ("catalogue", catalogue::check),
    ("circles", circles::check),
    ("dependencies", dependencies::check),
    ("equations", equations::check),
    ("examples", examples::check),
    ("facts", facts::check),
    ("golden", golden::check),
    ("invariants", invariants::check),
    ("layout", layout::check),
    ("links", links::check),
    ("lints", dependencies::check_lints),
    ("names", circles::check_names),
    ("notation", notation::check),
    ("purity", purity::check),
    ("sizes", sizes::check),
    ("units", units::check),
    ("wrapping", wrapping::check),
];

/// Prints all violations below the root, in the order of the checks; returns true if there is none.
pub(crate) fn is_tidy(root: &Path) -> bool {
    let repository = match Repository::read(root) {
        Ok(repository) => repository,
        Err(error) => {
            println!("cannot read {}: {error}", root.display());
            return false;
        }
    };
    let mut count = 0;
    for (name, check) in CHECKS {
        for Violation(text) in check(&repository) {
            println!("{text} [{name}]");
            count += 1;
        }
    }
    println!("tidy: {} checks, {count} violations", CHECKS.len());
    count == 0
}
