//! The answer of a command.

use phea_workbench::answer::{Answer as CommandAnswer, OutputFile, picture_at, picture_of};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

/// FinishedAnswer of a command: JSON, text and files, as the command prints and writes them.
#[pyclass(frozen, module = "phea._native", name = "Answer")]
pub(crate) struct FinishedAnswer {
    answer: CommandAnswer,
    /// Tables that the command writes while it computes them.
    tables: Vec<OutputFile>,
    /// Reason for which the request was stopped: an exception, or `False` of the callable.
    #[pyo3(get)]
    stopped: Option<Py<PyAny>>,
}

impl FinishedAnswer {
    pub(crate) fn new(
        answer: CommandAnswer,
        tables: Vec<OutputFile>,
        stopped: Option<Py<PyAny>>,
    ) -> FinishedAnswer {
        FinishedAnswer { answer, tables, stopped }
    }
}

#[pymethods]
impl FinishedAnswer {
    /// The JSON object that the command prints with `--json`.
    #[getter]
    fn json(&self) -> &str {
        &self.answer.json
    }

    /// The text that the command prints.
    #[getter]
    fn text(&self, py: Python<'_>) -> String {
        py.detach(|| self.answer.text())
    }

    /// The text as a fragment of a page.
    fn html(&self, py: Python<'_>) -> String {
        py.detach(|| self.answer.document.html())
    }

    /// The figures that a page of the text has, by name, as SVG.
    fn figures<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let drawings = py.detach(|| self.answer.drawings());
        let figures = PyDict::new(py);
        for drawing in drawings {
            figures.set_item(&drawing.name, PyBytes::new(py, &drawing.bytes))?;
        }
        Ok(figures)
    }

    /// True if the answer is yes.
    #[getter]
    fn affirmative(&self) -> bool {
        self.answer.affirmative
    }

    /// The files that the command writes with `--out`, by name; drawings as SVG and as PNG.
    fn files<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let drawn = py.detach(|| {
            let pictures = self.answer.files.iter().map(picture_of);
            pictures.collect::<Result<Vec<_>, _>>().map_err(|error| error.to_string())
        });
        let drawn = drawn.map_err(PyRuntimeError::new_err)?;
        let files = PyDict::new(py);
        for table in &self.tables {
            files.set_item(&table.name, PyBytes::new(py, &table.bytes))?;
        }
        for (file, picture) in self.answer.files.iter().zip(drawn) {
            files.set_item(&file.name, PyBytes::new(py, &file.bytes))?;
            if let Some(picture) = picture {
                files.set_item(&picture.name, PyBytes::new(py, &picture.bytes))?;
            }
        }
        Ok(files)
    }
}

/// The PNG of a drawing, with this many pixels to a unit of the drawing.
#[pyfunction(name = "picture_of")]
#[pyo3(signature = (svg, scale=2.0))]
pub(crate) fn png_of<'py>(py: Python<'py>, svg: Vec<u8>, scale: f64) -> PyResult<Bound<'py, PyBytes>> {
    let drawn = py.detach(|| picture_at(&OutputFile::new("drawing.svg", svg), scale));
    let picture = drawn.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    let picture = picture.ok_or_else(|| PyRuntimeError::new_err("this is no drawing"))?;
    Ok(PyBytes::new(py, &picture.bytes))
}
