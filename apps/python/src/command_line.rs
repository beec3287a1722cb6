//! The command, run in the process of Python.

use std::ffi::OsString;

use pyo3::prelude::*;

/// Runs a command line, whose first word is the name of the program; returns the exit status.
#[pyfunction]
pub(crate) fn run_command(python: Python<'_>, words: Vec<OsString>) -> u8 {
    python.detach(|| phea_cli::run(&words))
}
