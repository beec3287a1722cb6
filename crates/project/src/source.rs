//! The only interfaces to text and bytes: sources of files, and destinations of long ones. Shells
//! implement them over the file system.

use std::collections::BTreeMap;
use std::io;
use std::sync::{Mutex, PoisonError};

/// File produced by a command, named relative to the output folder.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputFile {
    /// File name with its extension.
    pub name: String,
    /// Content.
    pub bytes: Vec<u8>,
}

impl OutputFile {
    /// File of this name with a text or bytes.
    pub fn new(name: impl Into<String>, content: impl Into<Vec<u8>>) -> OutputFile {
        OutputFile { name: name.into(), bytes: content.into() }
    }
}

/// Source of files. A path is the text of the user, which only the implementation interprets.
pub trait Source: Sync {
    /// Bytes of a file.
    ///
    /// # Errors
    /// [`SourceError`] if there is no such file or it cannot be read.
    fn read(&self, path: &str) -> Result<Vec<u8>, SourceError>;

    /// Paths of the files in a folder, in a form that [`Source::read`] accepts; in any order. A
    /// path that is a file gives `None`.
    ///
    /// # Errors
    /// [`SourceError`] if the path does not exist, or cannot be read.
    fn list(&self, path: &str) -> Result<Option<Vec<String>>, SourceError>;
}

/// Error for a file that could not be read, with the reason.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cannot read {path}: {reason}")]
pub struct SourceError {
    /// Path as the user wrote it.
    pub path: String,
    /// Reason given by the system.
    pub reason: String,
}

/// Files in memory, for tests and for shells without a file system.
///
/// # Example
/// ```
/// use phea_project::source::{Memory, Source};
/// let source = Memory::default().with("hoses/soft.toml", "schema = 1");
/// assert_eq!(source.read("hoses/soft.toml")?, b"schema = 1");
/// assert_eq!(source.list("hoses")?, Some(vec!["hoses/soft.toml".to_string()]));
/// assert!(source.read("missing.toml").is_err());
/// # Ok::<(), phea_project::source::SourceError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Memory {
    files: BTreeMap<String, Vec<u8>>,
}

impl Memory {
    /// These files and one more.
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

/// Destination of files that are too long for memory: they are written as they are produced.
pub trait Destination {
    /// Begins a file. The file receives its name only when it is finished, and does not exist if it
    /// never is.
    ///
    /// # Errors
    /// [`WriteError`] if it cannot be begun.
    fn begin<'a>(&'a self, name: &str) -> Result<Box<dyn Unfinished + 'a>, WriteError>;

    /// Destination of a file of this name, for messages: the name with its folder.
    fn path_of(&self, name: &str) -> String {
        name.to_string()
    }
}

/// File that is being written. Data may be buffered until it is finished.
pub trait Unfinished: io::Write + Send {
    /// Stores the complete file under its name.
    ///
    /// # Errors
    /// Error of the system.
    fn finish(self: Box<Self>) -> io::Result<()>;
}

/// Error for a file that could not be written, with the reason.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cannot write {path}: {reason}")]
pub struct WriteError {
    /// Destination.
    pub path: String,
    /// Reason given by the system.
    pub reason: String,
}

/// Files in memory, for tests and for shells without a file system.
///
/// # Example
/// ```
/// use std::io::Write;
/// use phea_project::source::{Destination, HeldFiles};
/// let held = HeldFiles::default();
/// let mut table = held.begin("table.csv")?;
/// table.write_all(b"time_s\n")?;
/// table.finish()?;
/// let mut torn = held.begin("torn.csv")?;
/// torn.write_all(b"time")?;
/// drop(torn);
/// let files = held.into_files();
/// assert_eq!((files.len(), files[0].name.as_str(), files[0].bytes.as_slice()), (1, "table.csv", b"time_s\n".as_slice()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Default)]
pub struct HeldFiles(Mutex<Vec<OutputFile>>);

impl HeldFiles {
    /// All finished files, in order.
    pub fn into_files(self) -> Vec<OutputFile> {
        self.0.into_inner().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Destination for HeldFiles {
    fn begin<'a>(&'a self, name: &str) -> Result<Box<dyn Unfinished + 'a>, WriteError> {
        let file = OutputFile::new(name, []);
        Ok(Box::new(Growing { file, finished: &self.0 }))
    }
}

struct Growing<'a> {
    file: OutputFile,
    finished: &'a Mutex<Vec<OutputFile>>,
}

impl io::Write for Growing<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.bytes.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Unfinished for Growing<'_> {
    fn finish(self: Box<Self>) -> io::Result<()> {
        let Growing { file, finished } = *self;
        finished.lock().unwrap_or_else(PoisonError::into_inner).push(file);
        Ok(())
    }
}
