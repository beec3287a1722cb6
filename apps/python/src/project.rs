//! A project with every file that it names, in memory.

use phea_files::{FileSystem, LockedTable};
use phea_workbench::answer::Answer as CommandAnswer;
use phea_workbench::command::{
    self, CampaignRequest, CampaignRuns, CommandError, Request, answer_into, campaign_watched,
};
use phea_workbench::engineering::campaign::RowStore;
use phea_workbench::linear_values::{FamilyValues, family_values};
use phea_workbench::project::{self, Loaded, Refusal};
use phea_workbench::source::{HeldFiles, Memory, OutputFile, Source};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::answer::FinishedAnswer;
use crate::failure::{FailureKind, RequestFailure, refused};
use crate::request::{Asked, asked};
use crate::watch::PythonWatch;

/// A valid project with the bytes of all files that it names.
#[pyclass(frozen, module = "phea._native", name = "Project")]
pub(crate) struct HeldProject {
    pub(crate) files: Vec<(String, Vec<u8>)>,
    pub(crate) memory: Memory,
    pub(crate) loaded: Loaded,
}

#[pymethods]
impl HeldProject {
    /// Reads a project and the files that it names from the disk.
    #[staticmethod]
    fn read(
        py: Python<'_>,
        path: &str,
        settings: Vec<String>,
        catalogues: Vec<String>,
    ) -> PyResult<HeldProject> {
        py.detach(|| HeldProject::of(load(&FileSystem, path, &settings, &catalogues)?, &FileSystem))
    }

    /// Reads a project from files in memory.
    #[staticmethod]
    fn held(
        py: Python<'_>,
        path: &str,
        files: Vec<(String, Vec<u8>)>,
        settings: Vec<String>,
        catalogues: Vec<String>,
    ) -> PyResult<HeldProject> {
        py.detach(|| {
            let all = memory(&files);
            HeldProject::of(load(&all, path, &settings, &catalogues)?, &all)
        })
    }

    /// Path of the project file, as given.
    #[getter]
    fn path(&self) -> &str {
        &self.loaded.path
    }

    /// Text of the project file.
    #[getter]
    fn text(&self) -> std::borrow::Cow<'_, str> {
        String::from_utf8_lossy(&self.loaded.bytes)
    }

    /// Title of the project.
    #[getter]
    fn title(&self) -> &str {
        &self.loaded.project.title
    }

    /// SHA-256 of the project file, in hexadecimal.
    #[getter]
    fn sha256(&self) -> &str {
        &self.loaded.sha256
    }

    /// Settings that replace values of the file, each `path=value`.
    #[getter]
    fn settings(&self) -> Vec<String> {
        self.loaded.settings.clone()
    }

    /// Catalogue files and folders, as given.
    #[getter]
    fn catalogues(&self) -> Vec<String> {
        self.loaded.catalogues.clone()
    }

    /// Warnings about the project, as the command prints them; empty if there are none.
    #[getter]
    fn warnings(&self) -> String {
        project::render(&self.loaded.warnings, &self.loaded.texts, false)
    }

    /// All files of the project by their paths.
    fn files<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let files = PyDict::new(py);
        for (name, bytes) in &self.files {
            files.set_item(name, PyBytes::new(py, bytes))?;
        }
        Ok(files)
    }

    /// Answers a command of this name with these options.
    #[pyo3(signature = (name, options, callable=None))]
    fn answer(
        &self,
        py: Python<'_>,
        name: &str,
        options: &Bound<'_, PyDict>,
        callable: Option<Py<PyAny>>,
    ) -> PyResult<FinishedAnswer> {
        let Asked { request, table } = asked(name, options)?;
        let mut watcher = PythonWatch::new(callable);
        let (answer, tables) = py.detach(|| self.respond(&request, table.as_deref(), &mut watcher));
        match answer {
            Ok(answer) => Ok(FinishedAnswer::new(answer, tables, watcher.stopped)),
            Err(failure) => Err(failure.raised(py, watcher.stopped)),
        }
    }
}

impl HeldProject {
    /// Linear values that follow from the project alone.
    pub(crate) fn of_linear<T>(
        &self,
        values: impl FnOnce(&Loaded) -> Result<T, CommandError>,
    ) -> PyResult<T> {
        values(&self.loaded).map_err(|error| self.no_values(&error))
    }

    /// The family of its plants.
    pub(crate) fn family(&self) -> PyResult<FamilyValues> {
        let family = family_values(&self.memory, &self.loaded, &mut |_| true);
        family.map_err(|error| self.no_values(&error))
    }

    fn no_values(&self, error: &CommandError) -> PyErr {
        let json = command::error_json(&self.loaded, &Request::Linearize { sweep: None }, error);
        let text = error.refusal().map_or_else(|| error.to_string(), |report| report.render(false));
        refused(FailureKind::NoAnswer, json, text)
    }

    /// Failure of a computation of templates and bounds.
    pub(crate) fn values_failure(&self, error: &CommandError) -> RequestFailure {
        self.failure(&Request::Verify { proof: false, on_machine: false }, error, None)
    }

    /// A project with the files that it names, and no others.
    fn of(loaded: Loaded, source: &dyn Source) -> PyResult<HeldProject> {
        let named = loaded.named_files(source).into_iter();
        let files: Vec<_> =
            named.filter_map(|name| source.read(&name).ok().map(|bytes| (name, bytes))).collect();
        Ok(HeldProject { memory: memory(&files), files, loaded })
    }

    /// The answer, or the reason why there is none, and the tables that were written meanwhile.
    fn respond(
        &self,
        request: &Request,
        table: Option<&str>,
        watcher: &mut PythonWatch,
    ) -> (Result<CommandAnswer, RequestFailure>, Vec<OutputFile>) {
        let held = HeldFiles::default();
        let mut rows = RowsInMemory::default();
        let answer = match request {
            Request::Campaign(campaign) => self.run_campaign(campaign, (table, &held), &mut rows, watcher),
            _ => {
                let mut watch = |progress| watcher.look(progress);
                answer_into(
                    &self.memory,
                    &self.loaded,
                    &self.loaded.catalogues,
                    request,
                    Some(&held),
                    &mut watch,
                )
                .map_err(|error| self.failure(request, &error, watcher.stage))
            }
        };
        let mut tables = held.into_files();
        if table.is_none()
            && matches!(request, Request::Campaign(CampaignRequest { runs: CampaignRuns::All(_), .. }))
        {
            tables.insert(0, OutputFile::new("runs.csv", rows.text));
        }
        (answer, tables)
    }

    fn run_campaign(
        &self,
        campaign: &CampaignRequest,
        (table, held): (Option<&str>, &HeldFiles),
        rows: &mut RowsInMemory,
        watcher: &mut PythonWatch,
    ) -> Result<CommandAnswer, RequestFailure> {
        let mut locked = match table {
            Some(path) => Some(LockedTable::open(path.as_ref()).map_err(RequestFailure::Table)?),
            None => None,
        };
        let store: &mut dyn RowStore = match &mut locked {
            Some(table) => table,
            None => rows,
        };
        let mut watch = |progress| watcher.look(progress);
        let catalogues = &self.loaded.catalogues;
        let into = (Some(store), Some(held as &dyn phea_workbench::source::Destination));
        let answer = campaign_watched(&self.memory, &self.loaded, catalogues, campaign, into, &mut watch);
        answer.map_err(|error| {
            locked.iter().for_each(LockedTable::leave_no_trace);
            self.failure(&Request::Campaign(*campaign), &error, watcher.stage)
        })
    }

    pub(crate) fn failure(
        &self,
        request: &Request,
        error: &CommandError,
        stage: Option<&str>,
    ) -> RequestFailure {
        if let CommandError::Stopped(_) = error {
            let text = command::stopped_text(request, stage);
            let json = command::failure_json(Some(request.name()), Some(&self.loaded.sha256), &text);
            return RequestFailure::Command(FailureKind::Stopped, json, text);
        }
        let json = command::error_json(&self.loaded, request, error);
        match error.refusal() {
            _ if error.is_of_files() => RequestFailure::Command(FailureKind::File, json, error.to_string()),
            report => {
                let text = report.map_or_else(|| error.to_string(), |report| report.render(false));
                let kind = match error {
                    CommandError::Option(_) | CommandError::Shaping(_) => FailureKind::Project,
                    // the project was accepted when it was read: it lacks what is asked of it
                    _ => FailureKind::NoAnswer,
                };
                RequestFailure::Command(kind, json, text)
            }
        }
    }
}

/// RowsInMemory of a campaign in memory.
#[derive(Default)]
struct RowsInMemory {
    text: String,
}

impl RowStore for RowsInMemory {
    fn stored(&mut self) -> Result<String, String> {
        Ok(self.text.clone())
    }

    fn cut(&mut self, bytes: usize) -> Result<(), String> {
        self.text.truncate(bytes);
        Ok(())
    }

    fn append(&mut self, text: &str) -> Result<(), String> {
        self.text.push_str(text);
        Ok(())
    }
}

pub(crate) fn memory(files: &[(String, Vec<u8>)]) -> Memory {
    files.iter().fold(Memory::default(), |memory, (name, bytes)| memory.with(name, bytes.clone()))
}

fn load(source: &dyn Source, path: &str, settings: &[String], catalogues: &[String]) -> PyResult<Loaded> {
    project::read(source, path, settings, catalogues).map_err(|refusal: Refusal| {
        let json = command::refusal_json(source, path, "check", &refusal);
        refused(FailureKind::Project, json, refusal.render(false))
    })
}
