//! Errors of a request as one Python exception, which the package turns into its own.

use pyo3::exceptions::{PyBaseException, PyException};
use pyo3::prelude::*;

pyo3::create_exception!(_native, Refused, PyException);

/// FailureKind of a failure: it decides which exception of the package is raised.
#[derive(Clone, Copy)]
pub(crate) enum FailureKind {
    /// A file of the project, or a value of the request, contains errors.
    Project,
    /// A valid project lacks something that the request needs.
    NoAnswer,
    /// A file could not be written.
    File,
    /// The request was stopped before it had a result.
    Stopped,
}

/// The exception with its arguments: the kind, the JSON object of the command, its text for people.
pub(crate) fn refused(kind: FailureKind, json: String, text: String) -> PyErr {
    let kind = match kind {
        FailureKind::Project => "project",
        FailureKind::NoAnswer => "no_answer",
        FailureKind::File => "file",
        FailureKind::Stopped => "stopped",
    };
    Refused::new_err((kind, json, text))
}

/// Reason why a request has no answer.
pub(crate) enum RequestFailure {
    /// The kind, the JSON object of the command, and its text for people.
    Command(FailureKind, String, String),
    /// The table of a campaign cannot be opened.
    Table(String),
}

impl RequestFailure {
    /// The exception of a failure; that which stopped the request takes precedence.
    pub(crate) fn raised(self, py: Python<'_>, stopped: Option<Py<PyAny>>) -> PyErr {
        let reason = stopped.map(|reason| reason.into_bound(py));
        if let Some(error) = reason.filter(|reason| reason.is_instance_of::<PyBaseException>()) {
            return PyErr::from_value(error);
        }
        match self {
            RequestFailure::Command(kind, json, text) => refused(kind, json, text),
            RequestFailure::Table(message) => refused(FailureKind::File, String::new(), message),
        }
    }
}
