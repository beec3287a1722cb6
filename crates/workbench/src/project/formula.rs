//! Formulas in text: `"2116*(s + 75)/75"`.

/// A formula in `s` or `z` and named parameters, as written.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Formula {
    text: String,
}

impl Formula {
    /// As written.
    pub fn text(&self) -> &str {
        &self.text
    }
}
