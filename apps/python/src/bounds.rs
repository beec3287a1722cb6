//! Templates and bounds of a project as arrays.

use numpy::{Complex64, PyArray1, PyArray2};
use phea_workbench::bound_values::{ForbiddenGains, FrequencyValues, bound_values};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyComplex, PyTuple};

use crate::project::HeldProject;
use crate::watch::PythonWatch;

/// Names of the parameters, number of members, and at each design frequency: the frequency in
/// rad/s, the parameters and responses of the plants, the nominal loop or `None`, number, kind and
/// bound of each specification, and the bound of all of them.
#[pyfunction]
#[pyo3(signature = (project, callable=None))]
pub(crate) fn templates_and_bounds<'py>(
    py: Python<'py>,
    project: &HeldProject,
    callable: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyTuple>> {
    let mut watcher = PythonWatch::new(callable);
    let found = py.detach(|| {
        let mut watch = |progress| watcher.look(progress);
        bound_values(&project.memory, &project.loaded, &mut watch)
    });
    let found = match found {
        Ok(found) => found,
        Err(error) => return Err(project.values_failure(&error).raised(py, watcher.stopped)),
    };
    let frequencies: PyResult<Vec<_>> = found.frequencies.into_iter().map(|one| values(py, one)).collect();
    (found.parameters, found.members, frequencies?).into_pyobject(py)
}

fn values<'py>(py: Python<'py>, found: FrequencyValues) -> PyResult<Bound<'py, PyTuple>> {
    let complex = |&[re, im]: &[f64; 2]| Complex64::new(re, im);
    let plants = PyArray2::from_vec2(py, &found.plants);
    let plants = plants.map_err(|error| PyValueError::new_err(error.to_string()))?;
    let responses = PyArray1::from_vec(py, found.responses.iter().map(complex).collect::<Vec<_>>());
    let specifications = found.specifications.into_iter();
    let specifications: PyResult<Vec<_>> = specifications
        .map(|one| (one.number, one.kind, bound(py, one.forbidden)?).into_pyobject(py))
        .collect();
    let nominal_loop = found.nominal_loop.map(|[re, im]| PyComplex::from_doubles(py, re, im));
    let together = bound(py, found.together)?;
    (found.frequency_rad_per_s, plants, responses, nominal_loop, specifications?, together).into_pyobject(py)
}

/// Phases of a bound, and phase and ends of each forbidden interval of gains.
fn bound<'py>(py: Python<'py>, gains: ForbiddenGains) -> PyResult<Bound<'py, PyTuple>> {
    let array = |values: Vec<f64>| PyArray1::from_vec(py, values);
    let ForbiddenGains { phases_deg, phase_deg, from_gain, to_gain } = gains;
    (array(phases_deg), array(phase_deg), array(from_gain), array(to_gain)).into_pyobject(py)
}
