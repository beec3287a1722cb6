//! The files of the repository as one value, so that every check is a function that a test can call
//! with made-up files.

mod rust_file;

use std::cell::OnceCell;
use std::collections::BTreeMap;
use std::io;
use std::path::Path;

pub(crate) use rust_file::{RustFile, is_test_item};

/// Names that hold nothing of ours (`.git` is a file in a linked checkout).
const IGNORED: [&str; 6] = ["target", ".git", "out", ".venv", "__pycache__", "node_modules"];

/// Every file below the root by its path with forward slashes, and its text where it is UTF-8.
pub(crate) struct Repository {
    files: BTreeMap<String, Option<String>>,
    parsed: OnceCell<Parsed>,
}

/// The Rust files, and the paths of those that are none.
#[derive(Default)]
struct Parsed {
    files: Vec<RustFile>,
    errors: Vec<(String, syn::Error)>,
}

impl Repository {
    /// Reads everything below `root` but what is ignored.
    pub(crate) fn read(root: &Path) -> io::Result<Repository> {
        let mut files = BTreeMap::new();
        let mut folders = vec![root.to_path_buf()];
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(&folder)? {
                let entry = entry?;
                let name = entry.file_name().to_string_lossy().into_owned();
                let kind = entry.file_type()?;
                if IGNORED.contains(&name.as_str()) {
                    continue;
                }
                if kind.is_dir() {
                    folders.push(entry.path());
                } else if kind.is_file() {
                    let path = entry.path();
                    let relative = path.strip_prefix(root).unwrap_or(&path);
                    let key = relative.to_string_lossy().replace('\\', "/");
                    files.insert(key, String::from_utf8(std::fs::read(&path)?).ok());
                }
            }
        }
        Ok(Repository { files, parsed: OnceCell::new() })
    }

    /// A made-up repository.
    #[cfg(test)]
    pub(crate) fn from_texts(files: &[(&str, &str)]) -> Repository {
        let files = files.iter().map(|(path, text)| (path.to_string(), Some(text.to_string()))).collect();
        Repository { files, parsed: OnceCell::new() }
    }

    /// The text of one file.
    pub(crate) fn text(&self, path: &str) -> Option<&str> {
        self.files.get(path)?.as_deref()
    }

    /// All text files whose path passes, in the order of their paths.
    pub(crate) fn texts<'a>(
        &'a self,
        wanted: impl Fn(&str) -> bool + 'a,
    ) -> impl Iterator<Item = (&'a str, &'a str)> {
        let with_text = self.files.iter().filter_map(|(path, text)| Some((path.as_str(), text.as_deref()?)));
        with_text.filter(move |(path, _)| wanted(path))
    }

    /// Whether a file or folder of this path exists.
    pub(crate) fn exists(&self, path: &str) -> bool {
        let path = path.trim_end_matches('/');
        let folder = format!("{path}/");
        path.is_empty()
            || self.files.contains_key(path)
            || self.files.range(folder.clone()..).next().is_some_and(|(next, _)| next.starts_with(&folder))
    }

    /// Every Rust file that parses.
    pub(crate) fn rust_files(&self) -> &[RustFile] {
        &self.parse().files
    }

    /// The Rust files that do not parse.
    pub(crate) fn syntax_errors(&self) -> &[(String, syn::Error)] {
        &self.parse().errors
    }

    fn parse(&self) -> &Parsed {
        self.parsed.get_or_init(|| {
            let mut parsed = Parsed::default();
            for (path, text) in self.texts(|path| path.ends_with(".rs")) {
                match syn::parse_file(text) {
                    Ok(syntax) => parsed.files.push(RustFile::new(path, text, syntax)),
                    Err(error) => parsed.errors.push((path.to_string(), error)),
                }
            }
            parsed
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_and_folders_exist_and_prefixes_of_names_do_not() {
        let repository = Repository::from_texts(&[("book/src/theory.md", ""), ("book/src-old.md", "")]);
        for path in ["book", "book/src", "book/src/", "book/src/theory.md"] {
            assert!(repository.exists(path), "{path}");
        }
        for path in ["book/sr", "book/src/theory", "theory.md"] {
            assert!(!repository.exists(path), "{path}");
        }
    }

    #[test]
    fn a_file_that_does_not_parse_is_told() {
        let repository = Repository::from_texts(&[("a.rs", "fn f() {}"), ("b.rs", "fn f( {}")]);
        assert_eq!(repository.rust_files().len(), 1);
        assert_eq!(repository.syntax_errors()[0].0, "b.rs");
    }
}
