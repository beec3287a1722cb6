use std::fs;
use std::io::{ErrorKind, Read};

use phea_workbench::source::{Source, SourceError};

/// Size of the largest file that is read, in bytes; it ends the reading of an endless device.
const LARGEST_FILE: u64 = 256 << 20;

/// The file system as the workbench's source.
pub struct FileSystem;

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

/// A folder instead of a file; if it contains one project, that is suggested.
fn folder_reason(path: &str) -> String {
    let inside = FileSystem.list(path).ok().flatten().unwrap_or_default();
    let projects: Vec<&String> = inside.iter().filter(|file| file.ends_with(".toml")).collect();
    match projects.as_slice() {
        [only] => format!("it is a folder; did you mean {only}?"),
        _ => "it is a folder; name a file in it".to_string(),
    }
}

/// The usual reasons, in words that are equal on every system.
pub fn reason(error: &std::io::Error) -> String {
    match error.kind() {
        ErrorKind::NotFound => "no such file or folder".to_string(),
        ErrorKind::PermissionDenied => "permission denied".to_string(),
        ErrorKind::AlreadyExists | ErrorKind::NotADirectory => {
            "a file of that name is in the way".to_string()
        }
        ErrorKind::StorageFull => "the disk is full".to_string(),
        ErrorKind::FileTooLarge => "the file would be larger than is permitted (ulimit -f)".to_string(),
        ErrorKind::QuotaExceeded => "the quota of the disk is used up".to_string(),
        ErrorKind::ReadOnlyFilesystem => "the file system is read-only".to_string(),
        _ => error.to_string(),
    }
}
