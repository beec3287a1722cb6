//! Alternatives of a project as tasks, which several computers judge.

use phea_workbench::command::{AlternativesRequest, AlternativesTasks, CommandError, Request};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::answer::FinishedAnswer;
use crate::project::HeldProject;
use crate::request::{Options, alternatives_request};
use crate::watch::PythonWatch;

/// Number of tasks of a request; every alternative is prepared, so that an invalid one is found.
#[pyfunction]
pub(crate) fn alternatives_tasks(
    py: Python<'_>,
    project: &HeldProject,
    options: &Bound<'_, PyDict>,
) -> PyResult<usize> {
    of_tasks(py, project, options, None, |tasks, _| tasks.count())
}

/// Result of the task at a place, as bytes.
#[pyfunction]
#[pyo3(signature = (project, options, place, callable=None))]
pub(crate) fn alternative_judged<'py>(
    py: Python<'py>,
    project: &HeldProject,
    options: &Bound<'py, PyDict>,
    place: usize,
    callable: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyBytes>> {
    let judged = of_tasks(py, project, options, callable, |tasks, watcher| {
        tasks.judged(place, &mut |progress| watcher.look(progress))
    });
    judged.map(|bytes| PyBytes::new(py, &bytes))
}

/// The answer of the command from the results of all tasks, in any order.
#[pyfunction]
pub(crate) fn alternatives_joined(
    py: Python<'_>,
    project: &HeldProject,
    options: &Bound<'_, PyDict>,
    results: Vec<Vec<u8>>,
) -> PyResult<FinishedAnswer> {
    let answer = of_tasks(py, project, options, None, |tasks, _| tasks.joined(&results));
    answer.map(|answer| FinishedAnswer::new(answer, vec![], None))
}

fn of_tasks<T: Send>(
    py: Python<'_>,
    project: &HeldProject,
    options: &Bound<'_, PyDict>,
    callable: Option<Py<PyAny>>,
    of: impl FnOnce(&AlternativesTasks<'_>, &mut PythonWatch) -> Result<T, CommandError> + Send,
) -> PyResult<T> {
    let request: AlternativesRequest = alternatives_request(&Options(options))?;
    let mut watcher = PythonWatch::new(callable);
    let HeldProject { memory, loaded, .. } = project;
    let found = py.detach(|| {
        let catalogues = &loaded.catalogues;
        let mut watch = |progress| watcher.look(progress);
        let tasks = AlternativesTasks::new(memory, loaded, catalogues, &request, &mut watch)?;
        of(&tasks, &mut watcher)
    });
    let request = Request::Alternatives(request);
    found.map_err(|error| project.failure(&request, &error, watcher.stage).raised(py, watcher.stopped))
}
