//! Campaign whose table is a file that grows.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{ErrorKind, Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use phea_workbench::answer::Answer;
use phea_workbench::campaign::{Effort, RequestedRuns, RowStore, Shard};
use phea_workbench::command::{self, CampaignRequest, CampaignRuns, Request};
use phea_workbench::source::Destination;

use super::{FileSystem, failed, load, refused, reject_replaced_inputs};
use crate::arguments::Common;
use crate::failure::Failure;
use crate::file_system::reason;
use crate::inputs::Inputs;
use crate::interruption::Interruption;
use crate::messages::ProgressLine;
use crate::output::{Folder, unwritten, write};

/// Longest time after which the rows are flushed to the disk.
const FLUSH_INTERVAL: Duration = Duration::from_secs(2);

/// Request of the command line.
pub(super) fn request(
    runs: Option<u64>,
    seed: u32,
    shard: Option<&str>,
    run: Option<u64>,
    (threads, files): (Option<u16>, bool),
) -> Result<CampaignRequest, String> {
    let shard = shard.map(Shard::read).transpose().map_err(|error| error.to_string())?.unwrap_or_default();
    let all = Effort::on_all_cores();
    let effort = threads.map_or(all, |threads| Effort { threads: threads.into(), ..all });
    let chosen = match (run, runs) {
        (Some(run), _) => CampaignRuns::One(run),
        (None, runs) => CampaignRuns::All(RequestedRuns { runs: runs.unwrap_or_default(), shard, effort }),
    };
    Ok(CampaignRequest { seed, runs: chosen, files })
}

/// The answer, and the files that were written.
pub(super) fn answer_with_files(
    common: &Common,
    campaign: &CampaignRequest,
) -> Result<(Answer, Vec<PathBuf>), Failure> {
    let request = Request::Campaign(*campaign);
    let path = common.project.to_string_lossy();
    let loaded = load(&path, &common.settings, &common.catalogues, request.name())?;
    let inputs = Inputs::of_projects([&loaded]);
    reject_replaced_inputs(&inputs, (&request, &loaded), [common.out.as_deref(), None])?;
    let mut line = ProgressLine::default();
    let interruption = Interruption::listen();
    let mut table = match (&common.out, campaign.runs) {
        (Some(folder), CampaignRuns::All(wanted)) => {
            let path = folder.join(format!("{}.csv", wanted.shard.name()));
            Some(LockedTable::open(&path).map_err(|message| failed(&request, &loaded, &message))?)
        }
        _ => None,
    };
    let tables = common.out.as_deref().map(|folder| Folder::new(folder, &inputs));
    let destination = tables.as_ref().map(|tables| tables as &dyn Destination);
    let ledger = table.as_mut().map(|table| table as &mut dyn RowStore);
    let mut watch = |progress| {
        line.show_evenly(progress);
        !interruption.is_requested()
    };
    let catalogues = &common.catalogues;
    let into = (ledger, destination);
    let answer = command::campaign_watched(&FileSystem, &loaded, catalogues, campaign, into, &mut watch);
    line.clear();
    let answer = answer.map_err(|error| {
        table.iter().for_each(LockedTable::leave_no_trace);
        refused(&loaded, &request, (&error, line.stage()))
    })?;
    // the table remains locked until all other files are written
    let mut written: Vec<PathBuf> = table.iter().map(|table| table.path.clone()).collect();
    written.extend(tables.map(Folder::into_begun).unwrap_or_default());
    if let Some(folder) = &common.out {
        let more = write(folder, &answer.files, &inputs);
        written.extend(more.map_err(|message| failed(&request, &loaded, &message))?);
    }
    Ok((answer, written))
}

/// A file that grows at its end and is locked meanwhile: the system releases the lock when the
/// process ends.
struct LockedTable {
    path: PathBuf,
    file: File,
    /// True if there was no such file before.
    is_new: bool,
    /// Time of the last flush of all rows to the disk.
    flushed: Instant,
}

impl LockedTable {
    fn open(path: &Path) -> Result<LockedTable, String> {
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

    fn explain(&self, error: &std::io::Error) -> String {
        unwritten(&self.path, error)
    }

    /// Removes a table that this command created and to which it has written nothing.
    fn leave_no_trace(&self) {
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
