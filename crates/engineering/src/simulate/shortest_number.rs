//! Numbers in the fewest characters.

use std::fmt::Write as _;

/// Appends the shortest text that reads back as an identical number.
pub(crate) fn number(text: &mut String, value: f64) {
    let size = value.abs();
    let plain = size == 0.0 || (1e-4..1e15).contains(&size);
    // writing to a text cannot fail
    let _ = if plain { write!(text, "{value}") } else { write!(text, "{value:e}") };
}

#[cfg(test)]
mod tests {
    #[test]
    fn numbers_read_back() {
        let number = |value: f64| {
            let mut text = String::new();
            super::number(&mut text, value);
            text
        };
        for value in [0.0, 0.001, 1.0 / 3.0, -4000.0, 6.02e23, -1.6e-19, 5e-324] {
            assert_eq!(number(value).parse(), Ok(value));
        }
        assert_eq!((number(3.1), number(2e-7)), ("3.1".to_string(), "2e-7".to_string()));
    }
}
