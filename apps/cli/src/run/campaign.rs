//! A campaign whose table is a file that grows.

use std::fs::{self, File, OpenOptions};
use std::io::Write as _;
use std::num::NonZero;
use std::path::{Path, PathBuf};

use phea_workbench::answer::Answer;
use phea_workbench::campaign::{Effort, Ledger, Nowhere, Shard, Wanted};
use phea_workbench::command::{self, CampaignRequest, CampaignRuns, Request};

use super::{FileSystem, Refused, failed, load, refused};
use crate::arguments::Common;
use crate::file_system::write;
use crate::interruption::Interruption;
use crate::voice::ProgressLine;

/// What is asked for.
pub(super) fn request(
    runs: Option<u64>,
    seed: u32,
    shard: Option<&str>,
    run: Option<u64>,
    (threads, files): (Option<usize>, bool),
) -> Result<CampaignRequest, String> {
    let shard = shard.map(Shard::read).transpose().map_err(|error| error.to_string())?.unwrap_or_default();
    let threads = threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, NonZero::get));
    let asked = match (run, runs) {
        (Some(run), _) => CampaignRuns::One(run),
        (None, runs) => CampaignRuns::All(Wanted {
            runs: runs.unwrap_or_default(),
            shard,
            effort: Effort { threads, ..Effort::default() },
        }),
    };
    Ok(CampaignRequest { seed, asked, files })
}

/// The answer, and the files that were written.
pub(super) fn answered(common: &Common, asked: &CampaignRequest) -> Result<(Answer, Vec<PathBuf>), Refused> {
    let request = Request::Campaign(*asked);
    let path = common.project.to_string_lossy();
    let loaded = load(&path, &common.settings, &common.catalogues, &request)?;
    let mut line = ProgressLine::default();
    let interruption = Interruption::listen();
    let mut table = match (&common.out, asked.asked) {
        (Some(folder), CampaignRuns::All(wanted)) => {
            let path = folder.join(format!("{}.csv", wanted.shard.name()));
            Some(Table::open(&path).map_err(|message| failed(&request, &loaded, &message))?)
        }
        _ => None,
    };
    let ledger: &mut dyn Ledger = match &mut table {
        Some(table) => table,
        None => &mut Nowhere,
    };
    let mut watch = |progress| {
        line.show_evenly(progress);
        !interruption.is_asked()
    };
    let answer =
        command::campaign_watched(&FileSystem, &loaded, &common.catalogues, asked, ledger, &mut watch);
    line.clear();
    let answer = answer.map_err(|error| refused(&loaded, &request, &error))?;
    let mut written: Vec<PathBuf> = table.into_iter().map(|table| table.path).collect();
    if let Some(folder) = &common.out {
        let more = write(folder, &answer.files).map_err(|message| failed(&request, &loaded, &message))?;
        written.extend(more);
    }
    Ok((answer, written))
}

/// A file that grows at its end.
struct Table {
    path: PathBuf,
    file: File,
}

impl Table {
    fn open(path: &Path) -> Result<Table, String> {
        let unwritable = |error: std::io::Error| format!("cannot write {}: {error}", path.display());
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(unwritable)?;
        }
        let file = OpenOptions::new().create(true).append(true).open(path).map_err(unwritable)?;
        Ok(Table { path: path.to_path_buf(), file })
    }

    fn explain(&self, error: &std::io::Error) -> String {
        format!("cannot write {}: {error}", self.path.display())
    }
}

impl Ledger for Table {
    fn kept(&mut self) -> Result<String, String> {
        fs::read_to_string(&self.path)
            .map_err(|error| format!("cannot read {}: {error}", self.path.display()))
    }

    fn cut(&mut self, bytes: usize) -> Result<(), String> {
        self.file.set_len(bytes as u64).map_err(|error| self.explain(&error))
    }

    fn append(&mut self, text: &str) -> Result<(), String> {
        self.file.write_all(text.as_bytes()).map_err(|error| self.explain(&error))
    }
}
