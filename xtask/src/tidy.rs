//! The rules of the project that neither the compiler nor clippy knows, each a function from the
//! repository's files to the places that break it.

mod book;
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

use std::fmt;
use std::path::Path;

use crate::repository::Repository;

/// A place that breaks a rule.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Violation {
    path: String,
    line: usize,
    message: String,
}

impl Violation {
    /// A violation at a line counted from 1; line 0 is the file as a whole.
    fn new(path: &str, line: usize, message: impl Into<String>) -> Violation {
        Violation { path: path.to_string(), line, message: message.into() }
    }
}

impl fmt::Display for Violation {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            0 => write!(formatter, "{}: {}", self.path, self.message),
            line => write!(formatter, "{}:{line}: {}", self.path, self.message),
        }
    }
}

type Check = fn(&Repository) -> Vec<Violation>;

/// Every check by its name.
const CHECKS: &[(&str, Check)] = &[
    ("book", book::check),
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
        for violation in check(&repository) {
            println!("{violation} [{name}]");
            count += 1;
        }
    }
    println!("tidy: {} checks, {count} violations", CHECKS.len());
    count == 0
}
