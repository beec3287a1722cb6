use std::fs;
use std::path::{Path, PathBuf};

use phea_workbench::answer::OutputFile;
use phea_workbench::source::{Source, SourceError};

/// The file system as the workbench's source.
pub(crate) struct FileSystem;

impl Source for FileSystem {
    fn read(&self, path: &str) -> Result<Vec<u8>, SourceError> {
        fs::read(path).map_err(|error| refused(path, &error))
    }

    fn list(&self, path: &str) -> Result<Option<Vec<String>>, SourceError> {
        let refuse = |error: &std::io::Error| refused(path, error);
        if fs::metadata(path).map_err(|error| refuse(&error))?.is_file() {
            return Ok(None);
        }
        let mut files = Vec::new();
        for entry in fs::read_dir(path).map_err(|error| refuse(&error))? {
            let entry = entry.map_err(|error| refuse(&error))?;
            if entry.path().is_file() {
                files.push(entry.path().to_string_lossy().into_owned());
            }
        }
        files.sort();
        Ok(Some(files))
    }
}

fn refused(path: &str, error: &std::io::Error) -> SourceError {
    SourceError { path: path.to_string(), reason: error.to_string() }
}

/// Writes files into a folder, which is made if need be; gives their paths.
pub(crate) fn write(folder: &Path, files: &[OutputFile]) -> Result<Vec<PathBuf>, String> {
    let explain = |path: &Path, error: std::io::Error| format!("cannot write {}: {error}", path.display());
    fs::create_dir_all(folder).map_err(|error| explain(folder, error))?;
    files
        .iter()
        .map(|file| {
            let path = folder.join(&file.name);
            fs::write(&path, &file.bytes).map_err(|error| explain(&path, error)).map(|()| path)
        })
        .collect()
}

/// Writes the starter project into a folder that must be empty or absent.
pub(crate) fn write_starter(folder: &Path, text: &str) -> Result<PathBuf, String> {
    let occupied = folder.read_dir().is_ok_and(|mut entries| entries.next().is_some());
    if occupied || folder.is_file() {
        return Err(format!("{} exists and is not an empty folder; nothing was written", folder.display()));
    }
    let file = OutputFile { name: "project.toml".to_string(), bytes: text.as_bytes().to_vec() };
    write(folder, &[file]).map(|_| folder.join("project.toml"))
}
