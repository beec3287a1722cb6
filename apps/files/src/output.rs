//! Files that a command writes. A file receives its name only when it is complete: until then it
//! has a temporary name in its final folder. After an error the temporary file is removed; only a
//! killed process leaves it there.

use std::cell::RefCell;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use phea_workbench::answer::{OutputFile, picture_of};
use phea_workbench::source::{Destination, Unfinished, WriteError};

use crate::file_system::reason;
use crate::inputs::Inputs;

/// Number of bytes that are collected before they are written.
const COLLECTED: usize = 1 << 18;

/// A folder for long files, which are written as they are produced.
pub struct Folder<'f> {
    path: &'f Path,
    inputs: &'f Inputs,
    begun: RefCell<Vec<PathBuf>>,
}

impl<'f> Folder<'f> {
    /// A folder in which no file replaces one of the inputs.
    pub fn new(path: &'f Path, inputs: &'f Inputs) -> Folder<'f> {
        Folder { path, inputs, begun: RefCell::default() }
    }

    /// Every begun file, once, in order; all are complete if nothing failed.
    pub fn into_begun(self) -> Vec<PathBuf> {
        self.begun.into_inner()
    }
}

impl Destination for Folder<'_> {
    fn begin<'a>(&'a self, name: &str) -> Result<Box<dyn Unfinished + 'a>, WriteError> {
        let path = self.path.join(name);
        let refuse = |reason| WriteError { path: path.display().to_string(), reason };
        let file = Pending::begin(&path).map_err(|error| refuse(reason(&error)))?;
        self.inputs.reject_replacement(&path).map_err(refuse)?;
        let mut begun = self.begun.borrow_mut();
        if !begun.contains(&path) {
            begun.push(path);
        }
        Ok(Box::new(file))
    }

    fn path_of(&self, name: &str) -> String {
        self.path.join(name).display().to_string()
    }
}

/// A file that is not complete yet.
struct Pending {
    path: PathBuf,
    /// The temporary path; `None` if there is none.
    temporary: Option<Temporary>,
    file: BufWriter<File>,
}

/// A temporary file, which is removed unless it receives its name.
struct Temporary(PathBuf);

impl Drop for Temporary {
    fn drop(&mut self) {
        // the path does not exist any more once the file has its name
        let _ = fs::remove_file(&self.0);
    }
}

/// A file that is complete on the disk, and already has its name if it was not temporary.
struct Complete {
    path: PathBuf,
    temporary: Option<Temporary>,
}

impl Complete {
    /// Gives the file its name.
    fn name(self) -> io::Result<()> {
        self.temporary.map_or(Ok(()), |temporary| fs::rename(&temporary.0, &self.path))
    }
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
        let temporary = Some(Temporary(temporary));
        let pending = Pending { path, temporary, file: BufWriter::with_capacity(COLLECTED, file) };
        if let Some(known) = known {
            pending.file.get_ref().set_permissions(known.permissions())?;
        }
        Ok(pending)
    }

    /// The file with its content on the disk: a name must not reach the disk before the content.
    fn complete(mut self) -> io::Result<Complete> {
        self.file.flush()?;
        let Pending { path, temporary, file } = self;
        if temporary.is_some() {
            // on a file system that does not support this, nothing is lost
            match file.get_ref().sync_all() {
                Err(error) if !matches!(error.kind(), ErrorKind::InvalidInput | ErrorKind::Unsupported) => {
                    return Err(error);
                }
                _ => {}
            }
        }
        Ok(Complete { path, temporary })
    }
}

/// A name that is unique to this process, and short, however long the name of the file is.
fn temporary_name() -> String {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    format!(".phea-{}-{}.part", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed))
}

/// An error with its reason in plain words.
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
        self.complete().and_then(Complete::name).map_err(|error| plainly(&error))
    }
}

/// Rejects a folder that neither exists nor can be created, before the work whose result could not
/// be written.
pub fn expect_folder(folder: &Path) -> Result<(), String> {
    let existing = folder.ancestors().find_map(|part| fs::metadata(part).ok());
    match existing {
        Some(found) if !found.is_dir() => Err(unwritten(folder, &ErrorKind::NotADirectory.into())),
        _ => Ok(()),
    }
}

/// Writes files into a folder, drawings as SVG and as PNG, never over an input; returns their
/// paths. All files receive their names once all are complete: after an error the folder has no new
/// file.
pub fn write(folder: &Path, files: &[OutputFile], inputs: &Inputs) -> Result<Vec<PathBuf>, String> {
    let mut complete = Vec::new();
    for file in files {
        complete.push(completed(&folder.join(&file.name), &file.bytes, inputs)?);
        let picture = picture_of(file).map_err(|error| format!("cannot draw {}: {error}", file.name))?;
        if let Some(picture) = picture {
            complete.push(completed(&folder.join(&picture.name), &picture.bytes, inputs)?);
        }
    }
    let name = |(path, complete): (PathBuf, Complete)| {
        complete.name().map_err(|error| unwritten(&path, &error)).map(|()| path)
    };
    complete.into_iter().map(name).collect()
}

/// A complete file that has no name yet.
fn completed(path: &Path, bytes: &[u8], inputs: &Inputs) -> Result<(PathBuf, Complete), String> {
    let mut pending = Pending::begin(path).map_err(|error| unwritten(path, &error))?;
    // once its folder exists, the path is final
    inputs.reject_replacement(path)?;
    let complete = pending.file.write_all(bytes).and_then(|()| pending.complete());
    complete.map_err(|error| unwritten(path, &error)).map(|complete| (path.to_path_buf(), complete))
}

/// Writes a file to the given path, creating its folder if needed, and returns the path. The path
/// of an input is rejected.
pub fn write_as(path: &Path, file: &OutputFile, inputs: &Inputs) -> Result<PathBuf, String> {
    let (path, complete) = completed(path, &file.bytes, inputs)?;
    complete.name().map_err(|error| unwritten(&path, &error)).map(|()| path)
}

/// Message for a file or folder that cannot be written.
pub fn unwritten(path: &Path, error: &io::Error) -> String {
    format!("cannot write {}: {}", path.display(), reason(error))
}
