//! The names of specifications, for people.

use super::NamedSpecification;

/// `tracking`; empty where there is no specification.
pub(crate) fn name_words(named: Option<NamedSpecification>) -> &'static str {
    named.map_or("", |named| named.name.words())
}

/// `2 tracking`; the name alone of a specification that is not declared.
pub(crate) fn numbered(named: Option<NamedSpecification>) -> String {
    let name = name_words(named);
    number(named).map_or_else(|| name.to_string(), |number| format!("{number} {name}"))
}

/// A specification as a sentence names it: that of the file by its table and number.
pub(crate) fn stated(named: Option<NamedSpecification>) -> String {
    let name = name_words(named);
    match number(named) {
        Some(number) => format!("[[specification]] {number} ({name})"),
        None => format!("the limit on the {name}"),
    }
}

fn number(named: Option<NamedSpecification>) -> Option<usize> {
    named.and_then(|named| named.number)
}
