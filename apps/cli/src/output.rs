//! The files that a command writes. A file receives its name only when it is complete: until then
//! it has a temporary name in the same folder. After an error the temporary file is removed; only a
//! killed process leaves it behind.

use std::cell::RefCell;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use phea_workbench::answer::{OutputFile, picture_of};
use phea_workbench::source::{Destination, Unfinished, WriteError};

use crate::file_system::reason;

/// Bytes that are collected before they are written.
const COLLECTED: usize = 1 << 18;

/// A folder for long files, which are written as they are produced.
pub(crate) struct Folder<'f> {
    path: &'f Path,
    begun: RefCell<Vec<PathBuf>>,
}

impl<'f> Folder<'f> {
    pub(crate) fn new(path: &'f Path) -> Folder<'f> {
        Folder { path, begun: RefCell::default() }
    }

    /// Every file that was begun, in order; all are complete if nothing failed.
    pub(crate) fn into_begun(self) -> Vec<PathBuf> {
        self.begun.into_inner()
    }
}

impl Destination for Folder<'_> {
    fn begin<'a>(&'a self, name: &str) -> Result<Box<dyn Unfinished + 'a>, WriteError> {
        let path = self.path.join(name);
        let refuse = |error| WriteError { path: path.display().to_string(), reason: reason(&error) };
        let file = Pending::begin(&path).map_err(refuse)?;
        self.begun.borrow_mut().push(path);
        Ok(Box::new(file))
    }
}

/// A file that is not complete yet.
struct Pending {
    path: PathBuf,
    /// Its temporary path; `None` if it has none, and when it is complete.
    temporary: Option<PathBuf>,
    file: BufWriter<File>,
}

impl Pending {
    fn begin(path: &Path) -> io::Result<Pending> {
        if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
            fs::create_dir_all(folder)?;
        }
        // the target of a link is replaced, not the link
        let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
        let known = fs::metadata(&path).ok();
        if known.as_ref().is_some_and(|known| known.is_file() && known.permissions().readonly()) {
            return Err(ErrorKind::PermissionDenied.into());
        }
        // a terminal or a pipe has no temporary file
        if known.as_ref().is_some_and(|known| !known.is_file()) {
            let file = OpenOptions::new().write(true).open(&path)?;
            return Ok(Pending { path, temporary: None, file: BufWriter::with_capacity(COLLECTED, file) });
        }
        let temporary = path.with_file_name(temporary_name());
        let file = File::create(&temporary)?;
        let pending =
            Pending { path, temporary: Some(temporary), file: BufWriter::with_capacity(COLLECTED, file) };
        if let Some(known) = known {
            pending.file.get_ref().set_permissions(known.permissions())?;
        }
        Ok(pending)
    }

    fn whole(mut self) -> io::Result<()> {
        self.file.flush()?;
        let Some(temporary) = &self.temporary else { return Ok(()) };
        // a name must not reach the disk before the content; on a file system without such an order
        // nothing is lost
        match self.file.get_ref().sync_all() {
            Err(error) if !matches!(error.kind(), ErrorKind::InvalidInput | ErrorKind::Unsupported) => {
                return Err(error);
            }
            _ => {}
        }
        fs::rename(temporary, &self.path)?;
        self.temporary = None;
        Ok(())
    }
}

/// Unique to this process, and short, however long the name of the file is.
fn temporary_name() -> String {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    format!(".phea-{}-{}.part", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed))
}

impl Drop for Pending {
    fn drop(&mut self) {
        if let Some(temporary) = &self.temporary {
            let _ = fs::remove_file(temporary);
        }
    }
}

/// The same error in plain words.
fn plainly(error: &io::Error) -> io::Error {
    io::Error::new(error.kind(), reason(error))
}

impl Write for Pending {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes).map_err(|error| plainly(&error))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush().map_err(|error| plainly(&error))
    }
}

impl Unfinished for Pending {
    fn finish(self: Box<Self>) -> io::Result<()> {
        self.whole().map_err(|error| plainly(&error))
    }
}

/// Refuses a folder that can neither be nor be created, before the work whose result it would not
/// take.
pub(crate) fn expect_folder(folder: &Path) -> Result<(), String> {
    let existing = folder.ancestors().find_map(|part| fs::metadata(part).ok());
    match existing {
        Some(found) if !found.is_dir() => Err(unwritten(folder, &ErrorKind::NotADirectory.into())),
        _ => Ok(()),
    }
}

/// Writes files into a folder, drawings as SVG and as PNG; returns their paths.
pub(crate) fn write(folder: &Path, files: &[OutputFile]) -> Result<Vec<PathBuf>, String> {
    let mut written = Vec::new();
    for file in files {
        written.push(write_as(&folder.join(&file.name), file)?);
        let picture = picture_of(file).map_err(|error| format!("cannot draw {}: {error}", file.name))?;
        if let Some(picture) = picture {
            written.push(write_as(&folder.join(&picture.name), &picture)?);
        }
    }
    Ok(written)
}

/// Writes a file to the given path, creating its folder if needed, and returns the path.
pub(crate) fn write_as(path: &Path, file: &OutputFile) -> Result<PathBuf, String> {
    let written = Pending::begin(path).and_then(|mut pending| {
        pending.file.write_all(&file.bytes)?;
        pending.whole()
    });
    written.map_err(|error| unwritten(path, &error)).map(|()| path.to_path_buf())
}

/// Why a file or folder cannot be written.
pub(crate) fn unwritten(path: &Path, error: &io::Error) -> String {
    format!("cannot write {}: {}", path.display(), reason(error))
}
