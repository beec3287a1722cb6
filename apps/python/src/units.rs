//! Units of columns.

use phea_workbench::project::unit_of_key;
use phea_workbench::quantity::unit_of_name;
use pyo3::prelude::*;

/// Unit of a column: by the end of its name, or, for the path of a number of a project, by the
/// table of keys; empty if it has none.
#[pyfunction]
pub(crate) fn unit_of(name: &str) -> &'static str {
    let by_key = if name.contains('.') { unit_of_key(name) } else { None };
    by_key.or_else(|| unit_of_name(name)).unwrap_or_default()
}
