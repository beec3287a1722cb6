//! What no loop can satisfy, with its line, in words and in JSON.

use phea_engineering::impossible::impossibilities;

use crate::answer::Object;
use crate::impossible::late_of_all;
use crate::project::{LateError, Loaded, refused};
use crate::setup::Setup;
use crate::source::Source;
use crate::specification::SpecificationError;

/// A requirement that no loop can satisfy.
pub(super) struct Impossible {
    at: LateError,
    line: usize,
}

impl Impossible {
    /// All of a project.
    ///
    /// # Errors
    /// [`SpecificationError`] for a limit that is absent or not a function of frequency.
    pub(super) fn all(
        source: &dyn Source,
        loaded: &Loaded,
        setup: &Setup<'_>,
    ) -> Result<Vec<Impossible>, SpecificationError> {
        let found = impossibilities(source, setup)?;
        let of = |at: LateError| {
            let line = refused(source, loaded, &at).diagnostics.first().map_or(0, |found| found.line);
            Impossible { at, line }
        };
        Ok(late_of_all(&found, &setup.project.units).into_iter().map(of).collect())
    }

    /// The sentence with its line and cure.
    pub(super) fn sentence(&self) -> String {
        format!("{} (line {}): {}", self.at.message, self.line, self.at.help)
    }

    /// True where a sentence begins with this requirement.
    pub(super) fn is_stated_by(&self, sentence: &str) -> bool {
        sentence.starts_with(&self.at.message)
    }

    /// The key, what is impossible, and what would satisfy it.
    pub(super) fn object(&self) -> Object {
        Object::new()
            .with("key", self.at.path.as_str())
            .with("line", self.line)
            .with("sentence", self.at.message.as_str())
            .with("cure", self.at.help.as_str())
    }
}
