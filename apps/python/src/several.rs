//! Requests on several projects, on recordings, and on a certificate.

use phea_files::FileSystem;
use phea_workbench::answer::Answer as CommandAnswer;
use phea_workbench::audit::{self, CertificateError};
use phea_workbench::command::{
    self, IdentificationRequest, IdentifiedPart, IdentifyError, IdentifyOptions, LeakageModel,
    OptionSpelling, compare_watched,
};
use phea_workbench::project::LineSide;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::answer::FinishedAnswer;
use crate::failure::{FailureKind, RequestFailure};
use crate::project::{HeldProject, memory};
use crate::request::Options;
use crate::watch::PythonWatch;

/// Common scenarios of several projects.
#[pyfunction]
#[pyo3(signature = (projects, callable=None))]
pub(crate) fn compare(
    py: Python<'_>,
    projects: Vec<Py<HeldProject>>,
    callable: Option<Py<PyAny>>,
) -> PyResult<FinishedAnswer> {
    let mut watcher = PythonWatch::new(callable);
    let projects: Vec<&HeldProject> = projects.iter().map(Py::get).collect();
    let answer = py.detach(|| {
        let files: Vec<_> = projects.iter().flat_map(|project| project.files.iter().cloned()).collect();
        let loaded: Vec<_> = projects.iter().map(|project| project.loaded.clone()).collect();
        let mut watch = |progress| watcher.look(progress);
        compare_watched(&memory(&files), &loaded, true, &mut watch)
    });
    finished(
        py,
        answer.map_err(|error| {
            let first = projects
                .first()
                .map(|project| project.failure(&command::Request::Compare, &error, watcher.stage));
            first.unwrap_or_else(|| {
                RequestFailure::Command(FailureKind::NoAnswer, String::new(), error.to_string())
            })
        }),
        watcher.stopped,
    )
}

/// Coefficients from recorded tests; `of` names the part.
#[pyfunction]
#[pyo3(signature = (of, files, project, options, callable=None))]
pub(crate) fn identify(
    py: Python<'_>,
    of: &str,
    files: Vec<String>,
    project: Option<Py<HeldProject>>,
    options: &Bound<'_, PyDict>,
    callable: Option<Py<PyAny>>,
) -> PyResult<FinishedAnswer> {
    let request = identification(of, files, &Options(options))?;
    let loaded = project.as_ref().map(|project| &project.get().loaded);
    let mut watcher = PythonWatch::new(callable);
    let answer = py.detach(|| {
        let mut watch = |progress| watcher.look(progress);
        command::identification_watched(&FileSystem, loaded, &request, &mut watch)
    });
    let hash = loaded.map(|loaded| loaded.sha256.as_str());
    finished(py, answer.map_err(|error| unidentified(&error, hash)), watcher.stopped)
}

/// The request of the options of Python.
fn identification(
    of: &str,
    files: Vec<String>,
    options: &Options<'_, '_>,
) -> PyResult<IdentificationRequest> {
    let part = IdentifiedPart::ALL.into_iter().find(|part| part.name() == of);
    let options = IdentifyOptions {
        of: part.ok_or_else(|| PyValueError::new_err(format!("no part is called `{of}`")))?,
        files,
        starts: options.get("starts")?,
        seed: options.get("seed")?,
        bootstrap: options.get("bootstrap")?,
        leakage_model: leakage_model(options.get("leakage_model")?)?,
        period: options.get("period")?,
        settling: options.get("settling")?,
        segment: options.get("segment")?,
        coherence: options.get("coherence")?,
        side: side(options.get("side")?)?,
        figures: true,
    };
    options.request().map_err(|fault| PyValueError::new_err(fault.words(OptionSpelling::Keyword)))
}

fn unidentified(error: &IdentifyError, hash: Option<&str>) -> RequestFailure {
    let text = error.to_string();
    match error {
        IdentifyError::Stopped => RequestFailure::Command(
            FailureKind::Stopped,
            command::failure_json(Some("identify"), hash, &text),
            text,
        ),
        IdentifyError::Files(report) => RequestFailure::Command(
            FailureKind::Project,
            command::files_json("identify", hash, report),
            report.render(false),
        ),
        _ => RequestFailure::Command(
            FailureKind::NoAnswer,
            command::failure_json(Some("identify"), hash, &text),
            text,
        ),
    }
}

/// Every claim of a certificate, and whether it belongs to a project.
#[pyfunction]
#[pyo3(signature = (text, project=None))]
pub(crate) fn check_certificate(
    py: Python<'_>,
    text: &str,
    project: Option<Py<HeldProject>>,
) -> PyResult<FinishedAnswer> {
    let refused = |message: String| {
        let json = command::failure_json(Some("check-certificate"), None, &message);
        RequestFailure::Command(FailureKind::Project, json, message)
    };
    let project = project.as_ref().map(Py::get);
    let answer = py.detach(|| {
        let problem = project.map(|project| {
            command::robust_problem_of(&project.memory, &project.loaded, &mut |_| true)
                .map_err(|error| refused(error.to_string()))
        });
        match problem.transpose()? {
            None => audit::check_certificate(text),
            Some(problem) => audit::check_certificate_of(text, &problem),
        }
        .map_err(|error: CertificateError| refused(error.to_string()))
    });
    finished(py, answer, None)
}

fn finished(
    py: Python<'_>,
    answer: Result<CommandAnswer, RequestFailure>,
    stopped: Option<Py<PyAny>>,
) -> PyResult<FinishedAnswer> {
    match answer {
        Ok(answer) => Ok(FinishedAnswer::new(answer, vec![], stopped)),
        Err(failure) => Err(failure.raised(py, stopped)),
    }
}

fn leakage_model(name: Option<String>) -> PyResult<Option<LeakageModel>> {
    match name.as_deref() {
        None => Ok(None),
        Some("each_edge") => Ok(Some(LeakageModel::EachEdge)),
        Some("one_curve") => Ok(Some(LeakageModel::OneCurve)),
        Some(other) => {
            Err(PyValueError::new_err(format!("leakage_model is each_edge or one_curve, not {other}")))
        }
    }
}

fn side(name: Option<String>) -> PyResult<Option<LineSide>> {
    match name.as_deref() {
        None => Ok(None),
        Some("A") => Ok(Some(LineSide::A)),
        Some("B") => Ok(Some(LineSide::B)),
        Some(other) => Err(PyValueError::new_err(format!("side is A or B, not {other}"))),
    }
}
