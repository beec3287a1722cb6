//! Specifications as sentences name them.

use crate::robust::RobustProblem;

/// A specification of a problem: that of the file by its table and number.
pub(crate) fn stated(problem: &RobustProblem, index: usize) -> String {
    stated_words(problem.number_of(index), problem.name_of(index))
}

/// A specification by its number in the file, `None` where it has none, and its name.
pub(crate) fn stated_words(number: Option<usize>, name: &str) -> String {
    match number {
        Some(number) => format!("[[specification]] {number} ({name})"),
        None => format!("the limit on the {name}"),
    }
}
