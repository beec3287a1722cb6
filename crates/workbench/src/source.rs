//! The workbench's only door to text and bytes. Shells implement it over the file system.

use std::collections::BTreeMap;

/// Where files come from. A path is what the user wrote; only the implementation gives it a meaning.
pub trait Source {
    /// The bytes of a file.
    ///
    /// # Errors
    /// [`SourceError`] if there is no such file or it cannot be read.
    fn read(&self, path: &str) -> Result<Vec<u8>, SourceError>;

    /// The paths of the files in a folder, each such that [`Source::read`] takes it; in any order. A path that is a
    /// file gives `None`.
    ///
    /// # Errors
    /// [`SourceError`] if there is neither, or it cannot be read.
    fn list(&self, path: &str) -> Result<Option<Vec<String>>, SourceError>;
}

/// A file that could not be read, and why.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cannot read {path}: {reason}")]
pub struct SourceError {
    /// As the user wrote it.
    pub path: String,
    /// In the words of the system.
    pub reason: String,
}

/// Files held in memory, for tests and for shells without a file system.
///
/// # Example
/// ```
/// use phea_workbench::source::{Memory, Source};
/// let source = Memory::default().with("hoses/soft.toml", "schema = 1");
/// assert_eq!(source.read("hoses/soft.toml")?, b"schema = 1");
/// assert_eq!(source.list("hoses")?, Some(vec!["hoses/soft.toml".to_string()]));
/// assert!(source.read("missing.toml").is_err());
/// # Ok::<(), phea_workbench::source::SourceError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Memory {
    files: BTreeMap<String, Vec<u8>>,
}

impl Memory {
    /// The same files and one more.
    #[must_use]
    pub fn with(mut self, path: &str, content: impl Into<Vec<u8>>) -> Self {
        self.files.insert(path.to_string(), content.into());
        self
    }
}

impl Source for Memory {
    fn read(&self, path: &str) -> Result<Vec<u8>, SourceError> {
        let missing = || SourceError { path: path.to_string(), reason: "no such file".to_string() };
        self.files.get(path).cloned().ok_or_else(missing)
    }

    fn list(&self, path: &str) -> Result<Option<Vec<String>>, SourceError> {
        if self.files.contains_key(path) {
            return Ok(None);
        }
        let folder = format!("{}/", path.trim_end_matches('/'));
        let inside = |file: &&String| file.strip_prefix(&folder).is_some_and(|name| !name.contains('/'));
        let files: Vec<String> = self.files.keys().filter(inside).cloned().collect();
        if files.is_empty() {
            return Err(SourceError { path: path.to_string(), reason: "no such file or folder".to_string() });
        }
        Ok(Some(files))
    }
}
