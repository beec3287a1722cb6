//! Examples of everything that other programs may call: in the crates that compute, a file with a
//! public free function has an example with an assertion. The crates above are called through the
//! commands.

use super::Violation;
use super::dependencies::LOWER_CRATES;
use crate::repository::Repository;
use crate::rust_file::RustFile;

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let is_checked = |file: &&RustFile| {
        file.is_shipped() && LOWER_CRATES.iter().any(|folder| file.path.starts_with(folder))
    };
    repository.rust_files.iter().filter(is_checked).filter_map(check_file).collect()
}

/// A function at the level of the file that is `pub`: if its module is private and nothing exports
/// it, the compiler requires `pub(crate)`.
fn check_file(file: &RustFile) -> Option<Violation> {
    let function = file.shipped().find(|line| line.code.starts_with("pub fn "))?;
    let name = function.code.trim_start_matches("pub fn ").split(['(', '<']).next()?;
    let message = format!("`{name}` is public, but no example of this file asserts anything");
    (!has_example(file)).then(|| Violation::new(&file.path, function.number, message))
}

/// Returns true if a fence that is run as a test asserts something. A fence with any word other
/// than `rust` after its mark is another language, or is not run.
fn has_example(file: &RustFile) -> bool {
    let comments = file.shipped().filter_map(|line| line.text.trim().strip_prefix("//"));
    let mut fence = None;
    for line in comments.map(|comment| comment.trim_start_matches(['/', '!']).trim()) {
        match (line.strip_prefix("```"), fence) {
            (Some(language), None) => fence = Some(matches!(language, "" | "rust")),
            (Some(_), Some(_)) => fence = None,
            (None, Some(true)) if line.contains("assert") => return true,
            _ => {}
        }
    }
    false
}
