//! Progress of a request, reported to Python; a signal or the callable may stop the request.

use std::time::{Duration, Instant};

use phea_workbench::command::Progress;
use pyo3::prelude::*;

/// Longest time between two looks at the interpreter.
const INTERVAL: Duration = Duration::from_millis(50);

/// Watch of a request, which runs detached from the interpreter.
pub(crate) struct PythonWatch {
    callable: Option<Py<PyAny>>,
    looked: Option<Instant>,
    /// Reason for which the request is to stop: an exception, or `False` of the callable.
    pub(crate) stopped: Option<Py<PyAny>>,
    /// Last reported stage.
    pub(crate) stage: Option<&'static str>,
}

impl PythonWatch {
    pub(crate) fn new(callable: Option<Py<PyAny>>) -> PythonWatch {
        PythonWatch { callable, looked: None, stopped: None, stage: None }
    }

    /// Reports the progress if it is time to; returns false if the request is to stop.
    pub(crate) fn look(&mut self, progress: Progress) -> bool {
        self.stage = Some(progress.stage);
        if self.stopped.is_some() {
            return false;
        }
        if self.looked.is_some_and(|looked| looked.elapsed() < INTERVAL) {
            return true;
        }
        self.stopped = Python::attach(|py| match self.reason_to_stop(py, progress) {
            Ok(reason) => reason,
            Err(error) => Some(error.into_value(py).into_any()),
        });
        self.looked = Some(Instant::now());
        self.stopped.is_none()
    }

    fn reason_to_stop(&self, py: Python<'_>, progress: Progress) -> PyResult<Option<Py<PyAny>>> {
        py.check_signals()?;
        let Some(callable) = &self.callable else { return Ok(None) };
        let said = callable.bind(py).call1((progress.stage, progress.fraction))?;
        let no = pyo3::types::PyBool::new(py, false);
        Ok(if said.is(no) { Some(said.unbind()) } else { None })
    }
}
