//! A table of a campaign that grows at its end while it is computed, locked against other writers.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{ErrorKind, Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use phea_workbench::engineering::campaign::RowStore;

use crate::file_system::reason;
use crate::output::unwritten;

/// Longest time after which the rows are flushed to the disk.
const FLUSH_INTERVAL: Duration = Duration::from_secs(2);

/// A file that grows at its end and is locked meanwhile: the system releases the lock when the
/// process ends.
pub struct LockedTable {
    path: PathBuf,
    file: File,
    /// True if there was no such file before.
    is_new: bool,
    /// Time of the last flush of all rows to the disk.
    flushed: Instant,
}

impl LockedTable {
    /// Opens or creates the table, and its folder, and locks it.
    ///
    /// # Errors
    /// The reason, if it cannot be written or another process writes it.
    pub fn open(path: &Path) -> Result<LockedTable, String> {
        if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
            fs::create_dir_all(folder).map_err(|error| unwritten(folder, &error))?;
        }
        let is_new = !path.exists();
        let mut options = OpenOptions::new();
        options.create(true).read(true).write(true).truncate(false);
        let file = options.open(path).map_err(|error| unwritten(path, &error))?;
        file.try_lock().map_err(|error| match error {
            TryLockError::WouldBlock => format!(
                "another phea campaign is writing {}: wait until it ends, or choose another folder",
                path.display()
            ),
            TryLockError::Error(error) => {
                format!("cannot lock {}: {error}; choose a folder on another disk", path.display())
            }
        })?;
        Ok(LockedTable { path: path.to_path_buf(), file, is_new, flushed: Instant::now() })
    }

    /// Path of the table.
    pub fn path(&self) -> &Path {
        &self.path
    }

    fn explain(&self, error: &std::io::Error) -> String {
        unwritten(&self.path, error)
    }

    /// Removes a table that this command created and to which it has written nothing.
    pub fn leave_no_trace(&self) {
        if self.is_new && self.file.metadata().is_ok_and(|found| found.len() == 0) {
            let _ = fs::remove_file(&self.path);
        }
    }

    /// The file, next to the table, with rows of runs that were completed before an earlier one.
    fn ahead_path(&self) -> PathBuf {
        let mut name = self.path.clone().into_os_string();
        name.push(".ahead");
        name.into()
    }

    /// Flushes all rows to the disk.
    fn flush(&mut self) -> Result<(), String> {
        self.flushed = Instant::now();
        self.file.sync_data().map_err(|error| self.explain(&error))
    }
}

impl RowStore for LockedTable {
    fn stored(&mut self) -> Result<String, String> {
        let mut text = String::new();
        let read = self.file.rewind().and_then(|()| self.file.read_to_string(&mut text));
        read.map_err(|error| format!("cannot read {}: {error}", self.path.display()))?;
        Ok(text)
    }

    fn cut(&mut self, bytes: usize) -> Result<(), String> {
        self.file.set_len(bytes as u64).map_err(|error| self.explain(&error))
    }

    fn append(&mut self, text: &str) -> Result<(), String> {
        let before = self.file.seek(SeekFrom::End(0)).map_err(|error| self.explain(&error))?;
        let written = self.file.write_all(text.as_bytes());
        // an incomplete row is removed: the table has complete rows only
        written.map_err(|error| {
            let _ = self.file.set_len(before);
            self.explain(&error)
        })?;
        if self.flushed.elapsed() >= FLUSH_INTERVAL { self.flush() } else { Ok(()) }
    }

    fn ahead(&mut self) -> Result<String, String> {
        match fs::read(self.ahead_path()) {
            Ok(bytes) => Ok(String::from_utf8_lossy(&bytes).into_owned()),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(String::new()),
            Err(error) => Err(format!("cannot read {}: {}", self.ahead_path().display(), reason(&error))),
        }
    }

    fn keep_ahead(&mut self, text: &str) -> Result<(), String> {
        let path = self.ahead_path();
        let file = OpenOptions::new().create(true).append(true).open(&path);
        // an earlier incomplete row ends in its own line
        let written = file.and_then(|mut file| file.write_all(format!("\n{text}").as_bytes()));
        written.map_err(|error| unwritten(&path, &error))
    }

    fn forget_ahead(&mut self) -> Result<(), String> {
        match fs::remove_file(self.ahead_path()) {
            Err(error) if error.kind() != ErrorKind::NotFound => Err(unwritten(&self.ahead_path(), &error)),
            _ => self.flush(),
        }
    }
}
