//! Chunks of a campaign: rows that several computers compute, and the table that collects them.

use std::sync::{Mutex, PoisonError};

use phea_files::LockedTable;
use phea_workbench::command::{CampaignChunks, CommandError, Request};
use phea_workbench::engineering::campaign::{Effort, RowStore};
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;

use crate::project::HeldProject;
use crate::watch::PythonWatch;

/// Lines of the runs from `first` to before `end`, as the table of the campaign has them.
#[pyfunction]
#[pyo3(signature = (project, seed, first, end, threads=None, callable=None))]
pub(crate) fn campaign_lines(
    py: Python<'_>,
    project: &HeldProject,
    seed: u32,
    first: u64,
    end: u64,
    threads: Option<usize>,
    callable: Option<Py<PyAny>>,
) -> PyResult<String> {
    let mut watcher = PythonWatch::new(callable);
    let effort = Effort { threads: threads.unwrap_or(1), ..Effort::default() };
    let lines = py.detach(|| {
        let chunks = CampaignChunks::new(&project.memory, &project.loaded, seed)?;
        chunks.lines(first..end, effort, &mut |progress| watcher.look(progress))
    });
    lines.map_err(|error| campaign_failure(project, &error).raised(py, watcher.stopped))
}

fn campaign_failure(project: &HeldProject, error: &CommandError) -> crate::failure::RequestFailure {
    project.failure(&Request::Check, error, None)
}

/// Table of a campaign on the disk, locked against other writers until it is closed.
#[pyclass(frozen, module = "phea._native")]
pub(crate) struct CampaignTable {
    table: Mutex<Option<LockedTable>>,
}

#[pymethods]
impl CampaignTable {
    #[new]
    fn new(path: &str) -> PyResult<CampaignTable> {
        let table = LockedTable::open(path.as_ref()).map_err(PyOSError::new_err)?;
        Ok(CampaignTable { table: Mutex::new(Some(table)) })
    }

    /// Number of runs whose rows are stored, each verified; an empty table receives its header.
    fn stored(&self, py: Python<'_>, project: &HeldProject, seed: u32, runs: u64) -> PyResult<u64> {
        self.with(|table| {
            let chunks = CampaignChunks::new(&project.memory, &project.loaded, seed);
            let stored = chunks.and_then(|chunks| chunks.stored(runs, table));
            stored.map_err(|error| campaign_failure(project, &error).raised(py, None))
        })
    }

    /// Appends the lines of the next runs.
    fn append(&self, lines: &str) -> PyResult<()> {
        self.with(|table| table.append(lines).map_err(PyOSError::new_err))
    }

    /// Releases the table; one that was created and received nothing is removed.
    fn close(&self) {
        let table = self.table.lock().unwrap_or_else(PoisonError::into_inner).take();
        if let Some(table) = table {
            table.leave_no_trace();
        }
    }
}

impl CampaignTable {
    fn with<T>(&self, work: impl FnOnce(&mut LockedTable) -> PyResult<T>) -> PyResult<T> {
        let mut table = self.table.lock().unwrap_or_else(PoisonError::into_inner);
        work(table.as_mut().ok_or_else(|| PyValueError::new_err("the table is closed"))?)
    }
}
