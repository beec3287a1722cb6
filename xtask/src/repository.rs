//! The files of the repository as one value, so that every check is a function that a test can call
//! with invented files.

use std::collections::BTreeMap;
use std::io;
use std::path::Path;

use crate::rust_file::RustFile;

/// Names of files and folders that are not part of the project (`.git` is a file in a linked
/// checkout).
const IGNORED: [&str; 6] = ["target", ".git", "out", ".venv", "__pycache__", "node_modules"];

/// Every file below the root.
pub(crate) struct Repository {
    /// The texts by their path with forward slashes; empty if a file is not UTF-8.
    texts: BTreeMap<String, String>,
    /// The Rust files among them.
    pub(crate) rust_files: Vec<RustFile>,
}

impl Repository {
    pub(crate) fn new(texts: BTreeMap<String, String>) -> Repository {
        let rust = texts.iter().filter(|(path, _)| path.ends_with(".rs"));
        let rust_files = rust.map(|(path, text)| RustFile::new(path, text)).collect();
        Repository { texts, rust_files }
    }

    /// Reads everything below `root` except the ignored names.
    pub(crate) fn read(root: &Path) -> io::Result<Repository> {
        let mut texts = BTreeMap::new();
        let mut folders = vec![root.to_path_buf()];
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(&folder)? {
                let entry = entry?;
                let (path, kind) = (entry.path(), entry.file_type()?);
                if IGNORED.iter().any(|name| entry.file_name() == *name) {
                    continue;
                }
                if kind.is_dir() {
                    folders.push(path);
                } else if kind.is_file() {
                    let key = path.strip_prefix(root).unwrap_or(&path).to_string_lossy().replace('\\', "/");
                    texts.insert(key, String::from_utf8(std::fs::read(&path)?).unwrap_or_default());
                }
            }
        }
        Ok(Repository::new(texts))
    }

    /// The text of one file.
    pub(crate) fn text(&self, path: &str) -> Option<&str> {
        self.texts.get(path).map(String::as_str)
    }

    /// Files in this folder whose path has this ending, in the order of their paths.
    pub(crate) fn texts(&self, folder: &str, ending: &str) -> impl Iterator<Item = (&str, &str)> {
        let texts = self.texts.iter().map(|(path, text)| (path.as_str(), text.as_str()));
        texts.filter(move |(path, _)| path.starts_with(folder) && path.ends_with(ending))
    }

    /// Returns true if a file or folder of this path exists.
    pub(crate) fn exists(&self, path: &str) -> bool {
        let path = path.trim_end_matches('/');
        let folder = format!("{path}/");
        let mut below = self.texts.range(folder.clone()..);
        path.is_empty()
            || self.texts.contains_key(path)
            || below.next().is_some_and(|(next, _)| next.starts_with(&folder))
    }
}
