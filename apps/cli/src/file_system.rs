use std::fs;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

use phea_workbench::answer::OutputFile;
use phea_workbench::source::{Source, SourceError};

/// Bytes of the largest file that is read; endless devices end here.
const LARGEST_FILE: u64 = 256 << 20;

/// The file system as the workbench's source.
pub(crate) struct FileSystem;

impl Source for FileSystem {
    fn read(&self, path: &str) -> Result<Vec<u8>, SourceError> {
        let refuse = |error: &std::io::Error| refused(path, error);
        let file = fs::File::open(path).map_err(|error| refuse(&error))?;
        if file.metadata().is_ok_and(|metadata| metadata.is_dir()) {
            return Err(SourceError { path: path.to_string(), reason: folder_reason(path) });
        }
        let mut bytes = Vec::new();
        file.take(LARGEST_FILE + 1).read_to_end(&mut bytes).map_err(|error| refuse(&error))?;
        if bytes.len() as u64 > LARGEST_FILE {
            let reason = format!("it is larger than {} MiB", LARGEST_FILE >> 20);
            return Err(SourceError { path: path.to_string(), reason });
        }
        Ok(bytes)
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
    SourceError { path: path.to_string(), reason: reason(error) }
}

/// A folder where a file was expected; where it holds one project, that is what was meant.
fn folder_reason(path: &str) -> String {
    let inside = FileSystem.list(path).ok().flatten().unwrap_or_default();
    let projects: Vec<&String> = inside.iter().filter(|file| file.ends_with(".toml")).collect();
    match projects.as_slice() {
        [only] => format!("it is a folder; did you mean {only}?"),
        _ => "it is a folder; name a file in it".to_string(),
    }
}

/// The usual reasons in words that are the same on every system.
fn reason(error: &std::io::Error) -> String {
    match error.kind() {
        ErrorKind::NotFound => "no such file or folder".to_string(),
        ErrorKind::PermissionDenied => "permission denied".to_string(),
        ErrorKind::AlreadyExists | ErrorKind::NotADirectory => {
            "a file of that name is in the way".to_string()
        }
        ErrorKind::ReadOnlyFilesystem => "the file system is read-only".to_string(),
        _ => error.to_string(),
    }
}

/// Writes files into a folder; gives their paths.
pub(crate) fn write(folder: &Path, files: &[OutputFile]) -> Result<Vec<PathBuf>, String> {
    files.iter().map(|file| write_as(&folder.join(&file.name), file)).collect()
}

/// Writes a file under a path of its own, whose folder is made if need be, and gives that.
pub(crate) fn write_as(path: &Path, file: &OutputFile) -> Result<PathBuf, String> {
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        fs::create_dir_all(folder).map_err(|error| unwritten(folder, &error))?;
    }
    fs::write(path, &file.bytes).map_err(|error| unwritten(path, &error)).map(|()| path.to_path_buf())
}

/// Why a file or folder cannot be written.
pub(crate) fn unwritten(path: &Path, error: &std::io::Error) -> String {
    format!("cannot write {}: {}", path.display(), reason(error))
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
