//! The rules of the house that neither the compiler nor clippy knows, each one a function from the
//! repository's files to the places that break it.

mod book;
mod catalogue;
mod circles;
mod citation;
mod dependencies;
mod equations;
mod examples;
mod golden;
mod invariants;
mod keys;
mod layout;
mod links;
mod lints;
mod names;
mod notation;
mod parameters;
mod purity;
mod sizes;
mod units;
mod wrapping;

use std::fmt;
use std::path::Path;

use crate::repository::Repository;

/// One place that breaks a rule.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Violation {
    path: String,
    line: usize,
    message: String,
}

impl Violation {
    /// A violation at a line counted from 1; 0 stands for the file as a whole.
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
    ("syntax", syntax),
    ("book", book::check),
    ("catalogue", catalogue::check),
    ("circles", circles::check),
    ("dependencies", dependencies::check),
    ("equations", equations::check),
    ("examples", examples::check),
    ("golden", golden::check),
    ("invariants", invariants::check),
    ("keys", keys::check),
    ("layout", layout::check),
    ("links", links::check),
    ("lints", lints::check),
    ("names", names::check),
    ("notation", notation::check),
    ("purity", purity::check),
    ("sizes", sizes::check),
    ("units", units::check),
    ("wrapping", wrapping::check),
];

/// All violations in the repository, in the order of the checks.
pub(crate) fn violations(repository: &Repository) -> Vec<(&'static str, Violation)> {
    let named =
        |&(name, check): &(&'static str, Check)| check(repository).into_iter().map(move |v| (name, v));
    CHECKS.iter().flat_map(named).collect()
}

/// Whether nothing is untidy, and what is to be printed of it.
pub(crate) fn report(root: &Path) -> (bool, String) {
    let repository = match Repository::read(root) {
        Ok(repository) => repository,
        Err(error) => return (false, format!("cannot read {}: {error}\n", root.display())),
    };
    let found = violations(&repository);
    let each: String = found.iter().map(|(check, violation)| format!("{violation} [{check}]\n")).collect();
    (found.is_empty(), format!("{each}tidy: {} checks, {} violations\n", CHECKS.len(), found.len()))
}

/// Every Rust file parses, or no other check would see it.
fn syntax(repository: &Repository) -> Vec<Violation> {
    let errors = repository.syntax_errors().iter();
    errors.map(|(path, error)| Violation::new(path, error.span().start().line, error.to_string())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_repository_is_tidy() {
        let repository = Repository::read(&crate::root()).unwrap();
        let found: Vec<String> = violations(&repository)
            .iter()
            .map(|(check, violation)| format!("{violation} [{check}]"))
            .collect();
        assert!(found.is_empty(), "{} violations:\n{}", found.len(), found.join("\n"));
    }
}
