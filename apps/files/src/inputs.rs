//! Files that a command reads, or that its project names: no command replaces one of them.

use std::fs::{self, Metadata};
use std::path::{Component, Path, PathBuf};

use phea_workbench::project::Loaded;

use crate::file_system::FileSystem;

/// Files that must remain unchanged.
#[derive(Debug, Default)]
pub struct Inputs(Vec<InputFile>);

#[derive(Debug)]
struct InputFile {
    /// Path as written by the user or the project.
    named: String,
    /// Path without links, and the name in its own folder, which may be a link.
    places: [PathBuf; 2],
    metadata: Metadata,
}

impl Inputs {
    /// The regular files among these paths.
    pub fn of(paths: impl IntoIterator<Item = String>) -> Inputs {
        Inputs(paths.into_iter().filter_map(InputFile::of).collect())
    }

    /// The files of projects, and the files that those name.
    pub fn of_projects<'a>(projects: impl IntoIterator<Item = &'a Loaded>) -> Inputs {
        Inputs::of(projects.into_iter().flat_map(|loaded| loaded.named_files(&FileSystem)))
    }

    /// Adds further paths.
    pub fn and(mut self, paths: impl IntoIterator<Item = String>) -> Inputs {
        self.0.extend(Inputs::of(paths).0);
        self
    }

    /// Rejects a path at which a file would replace one of these: by an equal name, by one that
    /// differs only in case, through a link, or as another name of an input file.
    pub fn reject_replacement(&self, output: &Path) -> Result<(), String> {
        let place = resolved(output);
        let metadata = fs::metadata(&place).ok().filter(Metadata::is_file);
        let place = fs::canonicalize(&place).unwrap_or(place);
        let is_same = |input: &&InputFile| {
            input.places.iter().any(|own| is_one_place(own, &place))
                || metadata.as_ref().is_some_and(|other| is_one_file(&input.metadata, other))
        };
        let Some(input) = self.0.iter().find(is_same) else { return Ok(()) };
        Err(format!(
            "{} would replace {}, which this command reads or its project names: choose another folder or name; nothing was written",
            output.display(),
            input.named
        ))
    }

    /// Rejects a folder in which one of the files that may be written, by their names, would
    /// replace one of these.
    pub fn reject_replacement_in(
        &self,
        folder: &Path,
        may_write: impl Fn(&str) -> bool,
    ) -> Result<(), String> {
        // a folder that does not exist contains no input
        for entry in fs::read_dir(resolved(folder)).into_iter().flatten().flatten() {
            let name = entry.file_name();
            if name.to_str().is_some_and(&may_write) {
                self.reject_replacement(&folder.join(name))?;
            }
        }
        Ok(())
    }
}

impl InputFile {
    fn of(named: String) -> Option<InputFile> {
        let metadata = fs::metadata(&named).ok().filter(Metadata::is_file)?;
        let path = Path::new(&named);
        let target = fs::canonicalize(path).ok()?;
        let own = path.file_name().map(|name| resolved(parent(path)).join(name));
        let places = [own.unwrap_or_else(|| target.clone()), target];
        Some(InputFile { named, places, metadata })
    }
}

/// The folder of a file.
fn parent(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// A path without links and without `..`, as it will be once its folders exist.
fn resolved(path: &Path) -> PathBuf {
    let mut place = std::env::current_dir().unwrap_or_default();
    for part in path.components() {
        match part {
            Component::ParentDir => {
                place.pop();
            }
            Component::CurDir => {}
            Component::Prefix(_) | Component::RootDir | Component::Normal(_) => place.push(part),
        }
        place = fs::canonicalize(&place).unwrap_or(place);
    }
    place
}

/// True for two paths without links in one folder whose names differ at most in case.
fn is_one_place(one: &Path, other: &Path) -> bool {
    let name = |path: &Path| path.file_name().map(|name| name.to_string_lossy().to_lowercase());
    one.parent() == other.parent() && name(one) == name(other)
}

#[cfg(unix)]
fn is_one_file(one: &Metadata, other: &Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    (one.dev(), one.ino()) == (other.dev(), other.ino())
}

/// Systems that give files no number: other names of a file are not known.
#[cfg(not(unix))]
fn is_one_file(_one: &Metadata, _other: &Metadata) -> bool {
    false
}
