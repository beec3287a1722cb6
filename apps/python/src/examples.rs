//! The example projects, with the files that they name.

use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

/// Bytes of the files by their paths in the folder of the examples.
const EXAMPLES: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/examples.rs"));

/// Files of the examples by their paths.
#[pyfunction]
pub(crate) fn examples(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let files = PyDict::new(py);
    for (name, bytes) in EXAMPLES {
        files.set_item(name, PyBytes::new(py, bytes))?;
    }
    Ok(files)
}
